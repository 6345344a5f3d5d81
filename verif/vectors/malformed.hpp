// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/core.hpp"

namespace kage::vectors {

/// A frame that a core must refuse or cut short.
struct MalformedFrame {
  std::vector<std::uint32_t> words;
  FrameStatus status;  ///< of the golden core
  Level level = Level::spans;
};

/// Frames for each error that a core of this configuration can meet, in the order of the codes; fewer where chance
/// brought none. For an error it is the smallest of many damaged frames (stimulus/damage.hpp) that has it behind its
/// first line and before its last, else the smallest that has it. Frames at the span level, then, for a core with a
/// front end, as many at the polygon level. Follows from configuration and seed alone.
std::vector<MalformedFrame> malformed_frames(const Config& config, std::uint64_t seed);

}  // namespace kage::vectors
