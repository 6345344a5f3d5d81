// SPDX-License-Identifier: Apache-2.0

/// @file
/// The history of a pixel: every token of its frame that touched it, in order, with what it compared and what it left.
/// The golden core itself shows the states, so what is told is what it did.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kage/core.hpp"
#include "kage/token.hpp"

namespace kage {

/// A token's effect on the pixel.
struct PixelTouch {
  std::uint32_t token = 0;  ///< index in its frame; the header is 0
  std::uint32_t nth = 0;    ///< the same among the tokens behind the front end: those that it makes count
  Token what;               ///< the token
  bool made = false;        ///< by the front end, of the stream's token of that index
  std::string text;         ///< as `kage info --tokens` prints it; of one that is made with ", made by the front end"
  std::optional<std::uint32_t> z;           ///< the depth that was compared with the pixel's; none where no depth is
  std::optional<std::uint32_t> polyhedron;  ///< TREE: the draw index of the one that has the pixel in the tree
  std::string effect;                       ///< in words: "drawn: Z 812 is nearer than 4031"
  PixelState before;                        ///< the pixel, before the token
  PixelState after;                         ///< and after it
  std::uint32_t bias_before = 0;            ///< of the line, modulo 2^DSF_BITS
  std::uint32_t bias = 0;                   ///< after the token

  /// @return whether the token left the pixel or the line's bias other than it found them
  [[nodiscard]] bool changed() const { return !(before == after) || bias_before != bias; }
};

/// Writes a colour.
/// @param config says how many channels there are
/// @param color of each channel, as displayed or as a pixel holds it
/// @return "38,44,56", or one number where the core has one channel
std::string color_text(const Config& config, const std::array<std::uint16_t, 3>& color);

/// One comparison in the tree of a polyhedra line.
struct TreeMatch {
  int level = 0;              ///< 1 is that of the units
  LineView::UnitPixel left;   ///< of the lower units
  LineView::UnitPixel right;  ///< of the higher ones; clear where there is none
  bool right_wins = false;    ///< the lesser depth, then the lesser draw index
};

/// History of a pixel, from the frame's first token to its last.
struct PixelHistory {
  int x = 0;                                 ///< which pixel
  int y = 0;                                 ///< which line
  FrameStatus status;                        ///< how the frame ended; an error leaves background from its line on
  std::vector<PixelTouch> touches;           ///< in the order of the tokens
  std::vector<LineView::UnitPixel> units;    ///< what each expansion unit had for the pixel, where a TREE came
  std::vector<std::vector<TreeMatch>> tree;  ///< the path through the tree, level by level
  std::array<std::uint8_t, 3> color{};       ///< what left, as displayed
  std::string color_text;                    ///< why that colour, in words
};

/// Runs a frame and tells the history of a pixel. Cost: that of the frame once, one pixel looked at per token. Throws
/// Error if the frame has no such pixel.
/// @param config a legal configuration
/// @param words the whole frame, sound or not
/// @param x 0 .. width - 1
/// @param y 0 .. height - 1
/// @return the pixel's history
PixelHistory explain_pixel(const Config& config, std::span<const std::uint32_t> words, int x, int y);

/// Puts a pixel's state in words.
/// @param config that of the core
/// @param state of any pixel
/// @return "Z 812, color 10,20,30, lit, DSF 1"
std::string describe(const Config& config, const PixelState& state);

/// Puts in words what the tree of a polyhedra line did at the pixel. [Ohno 1985]
/// @param config that of the core
/// @param history of the pixel
/// @return a line for each unit that had something there and for each comparison of its way; empty if there was none
std::vector<std::string> describe_tree(const Config& config, const PixelHistory& history);

}  // namespace kage
