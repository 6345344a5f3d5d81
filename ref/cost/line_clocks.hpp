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
#include "polygon/span_tokens.hpp"

namespace kage {

/// Neighbouring lines whose mean is told beside the worst line: what a buffer of so many lines could even out.
inline constexpr std::size_t kLineWindow = 16;

struct LineClocks {
  struct Line {
    int frame = 0;
    int line = 0;
    std::uint64_t clocks = 0;
  };
  /// Neighbouring lines that decide how long a display's line must be.
  struct Need {
    double clocks = 0;  ///< of a display's line, at least
    int frame = 0;
    int first = 0;  ///< line
    int count = 0;
  };
  int frames = 0;
  int height = 0;                 ///< lines of the highest frame
  std::uint64_t lines = 0;        ///< of all frames
  std::uint64_t clocks = 0;       ///< of all lines
  Line worst;                     ///< the line with the most
  double worst_window = 0;        ///< mean of a line in the neighbouring lines that take most
  std::size_t window = 0;         ///< how many those are: kLineWindow, or all of a picture that has fewer
  std::uint64_t worst_frame = 0;  ///< clocks of the frame with the most
  Need need;                      ///< needed_line() of the frame that asks for most, or its width if that is more

  /// Mean clocks of a line, over all frames; 0 without lines.
  [[nodiscard]] double mean() const {
    return lines == 0 ? 0 : static_cast<double>(clocks) / static_cast<double>(lines);
  }
};

/// Clocks that a run of lines takes once, beyond those of its tokens and passes. They lie between the clock in which a
/// buffer of the way out is free and its line's first pixel at the port. rtl/core_display finds up to 2.
inline constexpr double kWayOutClocks = 8;

/// The least clocks T that a line of a display must have, so that a core which takes `lines` clocks for its lines is
/// never late. The way out holds two lines (docs/rtl.md): while one leaves and one waits, the core works on the next.
/// So m neighbouring lines have the time of m + 1 lines of the display, and T is the most of
/// (sum + kWayOutClocks) / (m + 1) over all runs of neighbours in a frame. Runs end with the frame if the display has a
/// blank line between frames. There m lines at a frame's end take up to (m + 1) T less kWayOutClocks, and n lines at
/// the next one's begin up to (n + 1) T less kWayOutClocks. They have the time of m + n + 1 lines and the blank one.
/// Without a blank line the core may be late by what both take. Where a line's colours come back before its TPs, the
/// line leaves the way out only once the line before has left. For such frames the two lines are those of a FIFO
/// behind the core, as video_out has one (docs/video.md).
/// @param lines clocks of each line of a frame, top to bottom
/// @return T, and the lines that decide it; 0 without lines
LineClocks::Need needed_line(std::span<const std::uint64_t> lines);

/// Adds frames up, for a core of one configuration. For a frame at the polygon level it counts the clocks of the core
/// behind the front end: those of the tokens that the front end makes or hands on.
class LineClockCounter {
 public:
  explicit LineClockCounter(const Config& config)
      : config_(config), layout_(config), spans_(config), counter_(config) {}

  /// A sound frame with its number. Throws Error if it is wider than MAX_WIDTH.
  void add(int frame, std::span<const std::uint32_t> words);

  /// The same token by token, for several counters that share a frame's decoded tokens: begin(), token() of each,
  /// end().
  void begin(int frame, const FrameHeader& header);
  void token(const Token& t) {
    (void)spans_.add(t, [this](const Token& of_spans, bool) { counter_.token(of_spans); });
  }
  void end();

  [[nodiscard]] const LineClocks& sums() const { return sums_; }
  [[nodiscard]] const Config& config() const { return config_; }

 private:
  Config config_;
  Layout layout_;
  SpanTokens spans_;
  PhaseCounter counter_;
  LineClocks sums_;
  int frame_ = 0;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace kage
