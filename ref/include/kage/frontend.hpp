// SPDX-License-Identifier: Apache-2.0
//
// The front end: scan conversion of a frame's geometry into the words of a frame. Integers only.
#pragma once

#include <cstdint>
#include <vector>

#include "kage/config.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Append the frame's words to `out`. Lines are made in bands, on up to `threads` threads (0: all there are); the words do not depend on it.
/// Cost is linear in the spans. Throws Error if the configuration cannot hold the frame (width, volumes).
void make_frame(const FrameGeometry& geometry, const Config& config, std::uint32_t frame_number, std::vector<std::uint32_t>& out,
                int threads = 0);

}  // namespace kage
