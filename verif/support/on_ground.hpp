// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "support/shapes.hpp"

namespace kage::verif {

/// A mesh's frame with a ground under it, in the sun, which stands so many degrees high.
inline SceneFrame on_ground(SceneFrame f, double degrees) {
  glm::dvec3 low(INFINITY);
  glm::dvec3 high(-INFINITY);
  for (const glm::dvec3& v : f.vertices)
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], v[i]);
      high[i] = std::max(high[i], v[i]);
    }
  const glm::dvec3 size = high - low;
  const double reach = std::max({size.x, size.y, size.z});
  add_solid(f, box_solid(), {low.x + size.x / 2, low.y - 0.03 * reach, low.z + size.z / 2},
            {1.2 * reach, 0.02 * reach, 1.2 * reach}, Turn{}, {0.7, 0.68, 0.62});
  Light sun;
  const double a = degrees * M_PI / 180;
  sun.direction = glm::normalize(glm::dvec3(0.8 * std::cos(a), -std::sin(a), -0.6 * std::cos(a)));
  f.lights = {sun};
  return f;
}

}  // namespace kage::verif
