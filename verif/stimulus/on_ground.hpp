// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/space.hpp"
#include "stimulus/shapes.hpp"

namespace kage::verif {

/// A mesh's frame with a ground under it, in the sun, which stands so many degrees high.
inline SceneFrame on_ground(SceneFrame f, double degrees) {
  SpaceBox box;
  for (const glm::dvec3& v : f.vertices) box.add(v);
  const glm::dvec3& low = box.low;
  const glm::dvec3 size = box.high - low;
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
