// SPDX-License-Identifier: Apache-2.0
//
// Phrases and quoting for lines that a person reads.
#pragma once

#include <cstdint>
#include <string>

#include "number/counted.hpp"

namespace kage::cli {

/// `text` as a shell reads it back.
std::string quoted(const std::string& text);

/// The command line that shows a waveform by its save file.
std::string gtkwave_line(const std::string& save_file);

/// ", 3 segments" for a line that tells spans; nothing where there are none, as in a core without units.
inline std::string and_segments(std::uint64_t segments) {
  return segments == 0 ? std::string() : ", " + counted(segments, "segment");
}

}  // namespace kage::cli
