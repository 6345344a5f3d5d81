// SPDX-License-Identifier: Apache-2.0
//
// Remarks for a person on a frame's picture, where it is not what the file asks for or is worse than it could be. They
// change no picture.
#pragma once

#include "kage/config.hpp"
#include "kage/geometry.hpp"

namespace kage {

struct Remarks {
  bool beyond_far = false;  ///< something in the picture lies beyond the camera's far plane, which cuts nothing
  bool backs =
      false;  ///< the picture may show a side of a face that its material does not (Sides), and Look::cull hides

  /// Length of a long step of depth, one that is longer than 1e-4 of the scene's extent at a surface in the picture
  /// (docs/numbers.md, "How long a step of depth is"). It is measured at the furthest such surface, where it is
  /// longest; 0 if no step is so long.
  double step = 0;
  double furthest = 0;    ///< the distance of that surface
  double extent = 0;      ///< the scene's extent, the diagonal of the box round it
  int z_bits_needed = 0;  ///< the least Z_BITS with which the step would not be longer; 0: no legal one
};

/// `look`: as the picture is made; only its choice of drawn faces counts here.
Remarks remarks(const SceneFrame& frame, const Config& config, int width, int height, const Look& look = {});

}  // namespace kage
