// SPDX-License-Identifier: Apache-2.0
// The demands of tests of whole scenes on a core, and on a scene.
#pragma once

#include <algorithm>

#include "kage/config.hpp"
#include "kage/scene.hpp"

namespace kage::verif {

/// The default core, wide enough for any picture that a test draws.
inline Config wide_enough() {
  Config c;
  c.max_width = 2047;
  return c;
}

/// Whether the scene's first frame has a translucent face.
inline bool translucent(const Scene& scene) {
  const SceneFrame f = scene.frame(0, scene.frame_count());
  return std::any_of(f.components.begin(), f.components.end(), [](const Component& c) { return c.translucent; });
}

}  // namespace kage::verif
