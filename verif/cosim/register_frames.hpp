// SPDX-License-Identifier: Apache-2.0
//
// The frames that the register check (register_check.hpp) sends of its own: for any legal configuration.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kage/config.hpp"

namespace kage::cosim {

/// The width of such a frame in pixels: 8, or MAX_WIDTH where lines are shorter.
int register_frame_width(const Config& config);

/// A blank line. Nothing else is in the core's way to the frame's end, so it takes the input though no output leaves.
std::vector<std::uint32_t> one_line(const Config& config);

/// A frame in two parts, neither of them empty.
struct FrameInParts {
  std::vector<std::uint32_t> words;
  std::size_t first = 0;  ///< words of the first part: whole beats
  int lines = 0;          ///< lines that end within the first part
};

/// Eight lines, a span on each, of which the second part has the last beat. At least a whole beat of the first part is
/// behind the header.
FrameInParts eight_lines(const Config& config);

/// A frame with an error, LINE on line 1, token 2; its number is not 0. The second part has the last beat, and from the
/// error to there are three whole beats or more.
FrameInParts early_error(const Config& config);

/// A frame whose END comes before its second line: LINE, found once the last beat has come.
std::vector<std::uint32_t> early_end(const Config& config);

/// For a core with two units or more. In the first part unit 0 gets its line; unit 1 gets less of it, or nothing.
FrameInParts unit_behind(const Config& config);

}  // namespace kage::cosim
