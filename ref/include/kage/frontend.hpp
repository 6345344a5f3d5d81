// SPDX-License-Identifier: Apache-2.0
//
// The front end: scan conversion of a frame's geometry into the words of a frame. Integers only.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kage/config.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Takes the next words of a frame.
using WordSink = std::function<void(std::span<const std::uint32_t> words)>;

/// Make the frame's words from first to last. Lines are made in bands, on up to `threads` threads (0: all there are),
/// and handed on band by band; the words do not depend on the number of threads. Cost is linear in the spans. Throws
/// Error if the configuration cannot hold the frame (width, volumes).
void make_frame(const FrameGeometry& geometry, const Config& config, std::uint32_t frame_number, const WordSink& sink,
                int threads = 0);

/// The same, appended to `out`.
void make_frame(const FrameGeometry& geometry, const Config& config, std::uint32_t frame_number,
                std::vector<std::uint32_t>& out, int threads = 0);

}  // namespace kage
