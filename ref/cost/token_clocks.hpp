// SPDX-License-Identifier: Apache-2.0
//
// Where the clocks of a frame go by design (docs/rtl.md, "Clocks"): each token's, summed by what it is for.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cost/generated/clock_phases.hpp"
#include "kage/stream.hpp"

namespace kage {

/// Clocks in the banked core between the last pixel of a tree's line and the first of its next line (docs/tree.md, "The
/// clocks of a line").
inline constexpr int kBetweenTreeLines = 4;

struct PhaseSums {
  struct Sum {
    std::uint64_t tokens = 0;
    std::uint64_t pixels = 0;  ///< in the ranges of spans, EV and ES
    std::uint64_t clocks = 0;
  };
  std::array<Sum, kPhases> of{};
  std::uint64_t video = 0;  ///< clocks in which a line's pixels take longer to leave than its tokens to come

  [[nodiscard]] std::uint64_t clocks() const {
    std::uint64_t sum = video;
    for (const Sum& s : of) sum += s.clocks;
    return sum;
  }
};

/// Adds up the tokens of a frame. Not counted: the header, waiting (as of a TREE for its line), and the pass that
/// brings colours back before the TPs of a line.
class PhaseCounter {
 public:
  explicit PhaseCounter(const Config& config) : config_(config), layout_(config) {}

  /// A frame whose lines are so wide.
  void start(int width) {
    width_ = width;
    line_ = 0;
    sums_ = {};
    lines_.clear();
    resolved_ = blends_ = false;
    waits_ = segments_ = since_tree_ = 0;
    had_tree_ = tree_here_ = false;
  }
  void token(const Token& token);
  /// One that stays in the front end: the core behind it has no clocks of it.
  void polygon_token() { ++sums_.of[static_cast<std::size_t>(Phase::polygons)].tokens; }

  [[nodiscard]] const PhaseSums& sums() const { return sums_; }

  /// The clocks that each line takes at most, top to bottom: those of its tokens, or of its pixels on their way out if
  /// these take longer. The wait before a line's first TP counts too: the pass that paints the line, and with counters
  /// the way out and back of its colours. So does a TREE's wait for the tree, which works a line ahead, a pixel a
  /// clock.
  [[nodiscard]] const std::vector<std::uint64_t>& lines() const { return lines_; }

 private:
  Config config_;
  Layout layout_;
  int width_ = 0;
  std::uint64_t line_ = 0;  // clocks of the line at hand
  PhaseSums sums_;
  std::vector<std::uint64_t> lines_;
  // State of the current line:
  bool resolved_ = false;       // it has had a RESOLVE
  bool blends_ = false;         // it has had a TP
  std::uint64_t waits_ = 0;     // clocks before its first TP, and before its TREE
  bool tree_here_ = false;      // it has had a TREE
  std::uint64_t segments_ = 0;  // clocks of its SEGs
  // State of the frame:
  bool had_tree_ = false;         // there was a TREE
  std::uint64_t since_tree_ = 0;  // clocks since the last one began
};

/// The most clocks that `count` neighbouring lines of a frame take together; in a frame with fewer lines, the clocks of
/// all.
std::uint64_t worst_window(std::span<const std::uint64_t> lines, std::size_t count);

}  // namespace kage
