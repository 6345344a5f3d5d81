// SPDX-License-Identifier: Apache-2.0
// Which side of a face the eye sees.
#pragma once

#include <glm/geometric.hpp>

#include "kage/geometry.hpp"

namespace kage {

/// Out of the face that has this triangle, twice its area long.
inline glm::dvec3 normal_of(const SceneFrame& frame, const Triangle& t) {
  const glm::dvec3& p = frame.vertices[t.vertex[0]];
  return glm::cross(frame.vertices[t.vertex[1]] - p, frame.vertices[t.vertex[2]] - p);
}

/// Above 0 where the eye sees the outside of the face that has this triangle, below 0 where it sees its inside.
inline double facing_of(const SceneFrame& frame, const Triangle& t, const glm::dvec3& normal) {
  const Camera& camera = frame.camera;
  return camera.perspective ? glm::dot(normal, camera.eye - frame.vertices[t.vertex[0]])
                            : -glm::dot(normal, camera.forward);
}

/// Whether Look::cull leaves a polygon out. `facing`: above 0 where the eye sees the outside, below 0 where it sees the
/// inside.
inline bool is_culled(const SceneFrame& frame, const Look& look, std::uint32_t polygon, double facing) {
  const Sides sides = frame.triangles[frame.polygons[polygon].triangle].sides;
  return look.cull && ((sides == Sides::front && facing < 0) || (sides == Sides::back && facing > 0));
}

}  // namespace kage
