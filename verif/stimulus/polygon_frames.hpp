// SPDX-License-Identifier: Apache-2.0
//
// Random frames at the polygon level (docs/stream.md, "The polygon level").
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stimulus/frames.hpp"

namespace kage::verif {

/// Contents of a frame at the polygon level.
struct PolygonStyle {
  /// Spans that come as tokens, and the tree. With `port`, planes and edges as a port takes them: sums may wrap along a
  /// span, and an edge may go on past its end.
  FrameStyle spans;
  int most_polygons = 4;  ///< that begin on a line
  int most_tokens = 4;    ///< spans of a line that come as tokens
  int most_lines = 6;     ///< that most polygons have
};

/// Append a valid frame for a core with ACTIVE > 0: polygons of all layers that the configuration has, up to ACTIVE of
/// them at once, with spans and near caps between. Returns how many tokens of each kind it has.
std::array<std::uint64_t, kKinds> random_polygon_frame(Random& random, const Config& c, int width, int height,
                                                       std::vector<std::uint32_t>& words, std::uint32_t number = 0,
                                                       const PolygonStyle& style = {});

}  // namespace kage::verif
