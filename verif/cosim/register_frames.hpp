// SPDX-License-Identifier: Apache-2.0
//
// The frames that the register check (register_check.hpp) sends of its own: sound ones, for any legal configuration.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kage/config.hpp"

namespace kage::cosim {

/// The width of such a frame in pixels: 8, or MAX_WIDTH where lines are shorter.
int register_frame_width(const Config& config);

/// A frame that a core has begun with before the last beat comes, whatever waits for that: eight lines, a span on each.
std::vector<std::uint32_t> eight_lines(const Config& config);

/// A frame in two parts, for a core with two units or more.
struct FrameInParts {
  std::vector<std::uint32_t> words;
  std::size_t first = 0;  ///< words of the first part: whole beats
};

/// In the first part unit 0 gets its line; unit 1 gets less of it, or nothing.
FrameInParts unit_behind(const Config& config);

}  // namespace kage::cosim
