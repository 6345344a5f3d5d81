// SPDX-License-Identifier: Apache-2.0
//
// Phrases for lines that a person reads.
#pragma once

#include <cstdint>
#include <string>

#include "file/shown.hpp"
#include "number/counted.hpp"

namespace kage::cli {

/// ", 3 segments" for a line that tells spans; nothing where there are none, as in a core without units.
inline std::string and_segments(std::uint64_t segments) {
  return segments == 0 ? std::string() : ", " + counted(segments, "segment");
}

}  // namespace kage::cli
