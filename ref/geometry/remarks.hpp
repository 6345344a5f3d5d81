// SPDX-License-Identifier: Apache-2.0
//
// What a person should be told of a frame's picture, because it is not what the file asks for or is worse than it could
// be. It changes no picture.
#pragma once

#include "kage/config.hpp"
#include "kage/geometry.hpp"

namespace kage {

struct Remarks {
  bool beyond_far = false;  ///< something in the picture lies beyond the camera's far plane, which cuts nothing
  bool backs =
      false;  ///< the picture may show a side of a face that its material does not (Sides), and Look::cull hides

  /// Where a step of depth is longer than 1e-4 of the scene's extent at a surface in the picture (docs/numbers.md, "How
  /// long a step of depth is"), else 0: how long it is at the furthest of these, where it is longest,
  double step = 0;
  double furthest = 0;    ///< the distance of that surface,
  double extent = 0;      ///< the scene's extent, the diagonal of the box round it,
  int z_bits_needed = 0;  ///< and the least Z_BITS with which it would not be longer; 0: no legal one
};

/// `look`: as the picture is made; what counts of it is which faces are drawn.
Remarks remarks(const SceneFrame& frame, const Config& config, int width, int height, const Look& look = {});

}  // namespace kage
