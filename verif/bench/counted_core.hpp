// SPDX-License-Identifier: Apache-2.0
// A core whose clocks count only where its pixels are right: a core that leaves its work out is quick.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cosim/core.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"

namespace kage::bench {

class CountedCore {
 public:
  explicit CountedCore(const Config& c) : rtl_(cosim::make_rtl(cosim::find_model(c).library, c)), golden_(c) {}

  /// Clocks of a frame in the RTL.
  std::int64_t clocks(const std::vector<std::uint32_t>& words) {
    std::vector<std::uint8_t> actual;
    std::vector<std::uint8_t> expected;
    const auto into = [](std::vector<std::uint8_t>& pixels) {
      return
          [&pixels](int, std::span<const std::uint8_t> line) { pixels.insert(pixels.end(), line.begin(), line.end()); };
    };
    const auto cycles = static_cast<std::int64_t>(rtl_->frame(words, into(actual)).cycles);
    golden_.frame(words, into(expected));
    if (actual != expected && same_) fmt::print("the core sends other pixels than the golden core\n");
    same_ = same_ && actual == expected;
    return cycles;
  }

  /// Every frame so far had the golden core's pixels.
  [[nodiscard]] bool same() const { return same_; }

 private:
  std::unique_ptr<cosim::RtlCore> rtl_;
  GoldenCore golden_;
  bool same_ = true;
};

}  // namespace kage::bench
