// SPDX-License-Identifier: Apache-2.0
//
// An expansion unit: face table, segments of two lines, Z generator. [Ohno 1985: segment buffer, face table, Z
// generator.] The golden counterpart of expansion_unit.sv.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kage/token.hpp"

namespace kage {

/// A line of pixels on its way through the tree. A pixel's key is its depth above its draw index: the least key wins.
struct TreeLine {
  std::vector<std::uint64_t> key;
  std::vector<std::uint64_t> attr;  ///< a packed colour, its class above

  void resize(std::size_t width) {
    key.resize(width);
    attr.resize(width);
  }
  static constexpr int kIndexBits = kGreatest.order_bits;
  static constexpr std::uint32_t kMostIndex = (1U << kIndexBits) - 1;
};

class ExpansionUnit {
 public:
  explicit ExpansionUnit(const Config& config) : config_(config) {}

  /// A new frame: no faces, no segments.
  void start();

  void add_face(const SegmentToken& face);

  /// A legal segment of the newest line, or the first one of the next.
  void add_segment(const SegmentToken& segment, int width);

  /// Expand the oldest whole line and forget it.
  void expand(TreeLine& out);

 private:
  struct Face {
    std::int64_t dz = 0;
    std::uint32_t index = 0;
    std::uint64_t attr = 0;
  };
  struct Segment {
    std::int64_t z = 0;
    int dx = 0;
    int face = 0;
  };

  Config config_;
  std::vector<Face> faces_;
  std::array<std::vector<Segment>, 2> lines_;  // the oldest whole line, and the one that is filled or whole
  int oldest_ = 0;
  int filling_ = 0;
  int sum_ = 0;  // pixels of the line that is filled
};

}  // namespace kage
