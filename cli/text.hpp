// SPDX-License-Identifier: Apache-2.0
//
// Phrases for lines that a person reads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "file/shown.hpp"
#include "number/counted.hpp"

namespace kage::cli {

/// ", 3 segments" for a line that tells spans; nothing where there are none, as in a core without units.
inline std::string and_segments(std::uint64_t segments) {
  return segments == 0 ? std::string() : ", " + counted(segments, "segment");
}

/// Breaks lines of more than `width` characters at blanks. The rest stands in comments of their own, set in below the
/// line's comment, so that YAML stays as it is. Lines without a comment stay whole.
inline std::string wrapped_comments(const std::string& text, std::size_t width = 120) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    at = end + 1;
    const std::size_t comment = line.find('#');
    const std::string begin = std::string(comment == std::string::npos ? 0 : comment, ' ').append("#   ");
    while (comment != std::string::npos && line.size() > width) {
      std::size_t blank = line.rfind(' ', width);
      // A long word stands in a line of its own.
      if (blank == std::string::npos || blank <= comment + 4) blank = line.find(' ', comment + 5);
      if (blank == std::string::npos) break;
      out += line.substr(0, blank) + "\n";
      line.replace(0, blank + 1, begin);
    }
    out += line + "\n";
  }
  return out;
}

}  // namespace kage::cli
