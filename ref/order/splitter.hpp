// SPDX-License-Identifier: Apache-2.0
//
// Which face's plane to cut a set of fragments by. Chance and doubles decide: the choice may be poor, never wrong.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "order/piece.hpp"

namespace kage::order {

/// splitmix64: the same numbers everywhere.
inline std::uint64_t next_random(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111eb;
  return z ^ (z >> 31U);
}

class SplitterChoice {
 public:
  explicit SplitterChoice(const Faces& faces) : faces_(faces) {}

  /// A face of `fragments`, which are not empty.
  std::uint32_t choose(std::span<const BuildFragment> fragments, std::uint64_t& random);

 private:
  void take_sample(std::span<const BuildFragment> fragments, std::uint64_t& random);
  [[nodiscard]] double cost(std::uint32_t face, double least) const;

  const Faces& faces_;
  std::vector<OrderPoint> points_;   // of the sample
  std::vector<std::uint32_t> ends_;  // of each sampled fragment in points_
  std::vector<std::uint32_t> tried_;
};

}  // namespace kage::order
