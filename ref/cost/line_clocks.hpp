// SPDX-License-Identifier: Apache-2.0
//
// How many clocks a core takes at most for the lines of a stream's frames (docs/rtl.md, "Clocks"): what a core that has
// to keep up with a display needs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cost/token_clocks.hpp"
#include "kage/config.hpp"

namespace kage {

/// Neighbouring lines whose mean is told beside the worst line: what a buffer of so many lines could even out.
inline constexpr std::size_t kLineWindow = 16;

struct LineClocks {
  struct Line {
    int frame = 0;
    int line = 0;
    std::uint64_t clocks = 0;
  };
  int frames = 0;
  int height = 0;                 ///< lines of the highest frame
  std::uint64_t lines = 0;        ///< of all frames
  std::uint64_t clocks = 0;       ///< of all lines
  Line worst;                     ///< the line with the most
  double worst_window = 0;        ///< mean of a line in the neighbouring lines that take most
  std::size_t window = 0;         ///< how many those are: kLineWindow, or all of a picture that has fewer
  std::uint64_t worst_frame = 0;  ///< clocks of the frame with the most

  /// Of a line, over all frames; 0 without lines.
  [[nodiscard]] double mean() const {
    return lines == 0 ? 0 : static_cast<double>(clocks) / static_cast<double>(lines);
  }
};

/// Adds frames up, for a core of one configuration.
class LineClockCounter {
 public:
  explicit LineClockCounter(const Config& config) : config_(config), layout_(config), counter_(config) {}

  /// A sound frame with its number. Throws Error if it is wider than MAX_WIDTH.
  void add(int frame, std::span<const std::uint32_t> words);

  [[nodiscard]] const LineClocks& sums() const { return sums_; }
  [[nodiscard]] const Config& config() const { return config_; }

 private:
  Config config_;
  Layout layout_;
  PhaseCounter counter_;
  LineClocks sums_;
};

}  // namespace kage
