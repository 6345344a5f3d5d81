// SPDX-License-Identifier: Apache-2.0
//
// kage info STREAM --clocks: how many clocks a core takes at most for a stream's lines (docs/rtl.md, "Clocks").
#pragma once

#include <cstdint>
#include <string>

#include "kage/config.hpp"
#include "kage/stream.hpp"
#include "results.hpp"

namespace kage::cli {

/// The clocks of all sound frames of a stream. A core that has to keep up with a display needs them for its worst line,
/// because a line buffer holds few lines and heavy lines lie together.
struct StreamClocks {
  /// Neighbouring lines whose mean is told beside the worst line: what a buffer of so many lines could even out.
  static constexpr int kWindow = 16;

  struct Line {
    int frame = 0;
    int line = 0;
    std::uint64_t clocks = 0;
  };

  Config config;
  int frames = 0;
  int height = 0;                 ///< lines of the highest frame
  double mean = 0;                ///< of a line, over all frames
  Line worst;                     ///< the line with the most clocks
  double worst_window = 0;        ///< mean of a line in the kWindow neighbouring lines that take most
  std::uint64_t worst_frame = 0;  ///< clocks of the frame with the most
};

/// Counts them for a core of configuration `config`, whose pixel parameters are the stream's. Throws Error if a
/// frame is wider than MAX_WIDTH; `name` is the stream's in it.
StreamClocks clocks_of(const std::string& name, const StreamFile& file, const Config& config);

/// For people: two lines.
std::string to_text(const StreamClocks& clocks);
Json to_json(const StreamClocks& clocks);

}  // namespace kage::cli
