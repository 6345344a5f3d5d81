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

/// A name or a sentence from elsewhere, for a line that a person reads: where control characters are in it, they are
/// gone, since a line break would begin a line of its own, which may be a command to whoever reads the output.
std::string shown(const std::string& text);

/// The command line that shows a waveform by its save file.
std::string gtkwave_line(const std::string& save_file);

/// ", 3 segments" for a line that tells spans; nothing where there are none, as in a core without units.
inline std::string and_segments(std::uint64_t segments) {
  return segments == 0 ? std::string() : ", " + counted(segments, "segment");
}

}  // namespace kage::cli
