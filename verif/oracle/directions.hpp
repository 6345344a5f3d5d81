// SPDX-License-Identifier: Apache-2.0
//
// Directions spread evenly over the sphere.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <vector>

namespace kage::verif {

/// Unit vectors on a golden spiral from pole to pole.
inline std::vector<glm::dvec3> even_directions(int count) {
  const double turn = M_PI * (std::sqrt(5.0) - 1);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double radius = std::sqrt(1 - z * z);
    directions.emplace_back(radius * std::cos(turn * i), radius * std::sin(turn * i), z);
  }
  return directions;
}

}  // namespace kage::verif
