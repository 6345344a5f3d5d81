// SPDX-License-Identifier: Apache-2.0
//
// Where an edge of the polygon level comes to a border between two pixels.
#pragma once

#include <cstdint>

#include "kage/token.hpp"

namespace kage::verif {

/// How far right of the last pixel centre an edge that goes down crosses the centre of line `y`: 0 .. 256 dy - 1, in
/// 1 / (256 dy) of a pixel, where dy is the edge's height in subpixels.
inline std::int64_t past_centre(const PolygonToken& edge, int y) {
  const std::int64_t dx = std::int64_t{edge.bottom_x} - edge.top_x;
  const std::int64_t dy = std::int64_t{edge.bottom_y} - edge.top_y;
  const std::int64_t crossing = (std::int64_t{edge.top_x} - 128) * dy + (std::int64_t{y} * 256 + 128 - edge.top_y) * dx;
  const std::int64_t rest = crossing % (256 * dy);
  return rest < 0 ? rest + 256 * dy : rest;
}

/// Whether the step to line `y` is a tie: a remainder that reaches the height, and nothing is left of it. A front end
/// that takes it for less begins the line's span a pixel too early.
inline bool edge_tie(const PolygonToken& edge, int y) {
  const std::int64_t past = past_centre(edge, y);
  return 1 <= past && past <= 256;
}

}  // namespace kage::verif
