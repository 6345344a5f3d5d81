// SPDX-License-Identifier: Apache-2.0
//
// A frame taken apart, and frames of some of another's lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "contract/kinds.hpp"
#include "kage/stream.hpp"

namespace kage::verif {

using Words = std::vector<std::uint32_t>;

/// A frame taken apart.
struct Parts {
  Words header;
  std::vector<Words> tokens;
  Words rest;  ///< from the first word on that begins no token, or behind END
};

Parts apart(const Config& config, const Words& words);
Words together(const Parts& parts);

inline bool is(const Words& token, Kind kind) { return kind_of(token[0]) == kind; }
inline std::uint32_t width_of(const Words& frame) { return static_cast<std::uint32_t>(FrameHeader::read(frame).width); }

/// Where a SEG is: SEGs run ahead, and a unit's of a line sum to the width.
class SegmentPlaces {
 public:
  struct Place {
    std::size_t line = 0;
    std::uint32_t x = 0;  ///< its first pixel
  };

  explicit SegmentPlaces(const Words& header) : width_(width_of(header)) {}

  /// The next SEG's place.
  Place next(const SegmentToken& s);

 private:
  std::uint32_t width_;
  std::vector<Place> units_;
};

/// The frame with those of its lines alone for which `keeps` is true: height and EOLs are numbered anew, and SEGs go
/// with their line. Tokens before the first line stay. A frame that would have no line is given back as it is.
Words only_lines(const Config& config, const Words& words, const std::function<bool(std::size_t line)>& keeps);

}  // namespace kage::verif
