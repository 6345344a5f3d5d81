// SPDX-License-Identifier: Apache-2.0
//
// What a person should be told of a frame's picture, because it is not what the file asks for or is worse than it could
// be. It changes no picture.
#pragma once

#include "kage/config.hpp"
#include "kage/scene.hpp"

namespace kage {

struct Remarks {
  bool beyond_far = false;  ///< something in the picture lies beyond the camera's far plane, which cuts nothing
  bool backs =
      false;  ///< the picture may show a side of a face that its material does not (Sides), and Look::cull hides

  /// Where the steps of depth are too coarse for the picture (docs/numbers.md, "A near plane too near"), else 0: the
  /// distance of the nearest surface in the picture,
  double nearest = 0;
  double steps = 0;        ///< how many steps of depth there are from it to infinity,
  double near_needed = 0;  ///< and the nearest near plane with which they would be fine enough.
};

Remarks remarks(const SceneFrame& frame, const Config& config, int width, int height);

}  // namespace kage
