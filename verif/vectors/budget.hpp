// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kage/pipeline.hpp"

namespace kage::vectors {

/// A frame of some of a source's lines.
struct ChosenFrame {
  int from = 0;                      ///< the source's frame
  std::vector<std::size_t> lines;    ///< its lines, from the top
  std::vector<std::uint32_t> words;  ///< a frame of these lines
};

/// Bytes of a pack that a board must hold to judge itself: the beats, and a signature a line.
std::uint64_t board_bytes(const Config& config, std::uint64_t words, std::uint64_t lines);

/// The lines of a source that fit into so many bytes of board_bytes(), the hardest first. While a line reaches points
/// of coverage that no chosen one has (stimulus/coverage.hpp), the line that reaches most of them for its bytes is
/// next. Then come the lines with the most words. A line at the top is taken where two are alike. Nothing if not a
/// single line fits. Throws as FrameSource::frame(); frames must be sound.
std::vector<ChosenFrame> choose_lines(FrameSource& source, std::uint64_t bytes);

}  // namespace kage::vectors
