// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kage/order.hpp"
#include "kage/scene.hpp"

namespace kage::scene {

/// The polygons of a frame, by the same numbers, for an OrderTree.
inline OrderMesh order_mesh(const SceneFrame& frame) {
  OrderMesh mesh;
  mesh.vertices.reserve(frame.vertices.size());
  for (const glm::dvec3& p : frame.vertices) mesh.vertices.push_back({p.x, p.y, p.z});
  mesh.corners = frame.corners;
  mesh.polygons.reserve(frame.polygons.size());
  for (const Polygon& p : frame.polygons) mesh.polygons.push_back({p.first, p.count});
  return mesh;
}

}  // namespace kage::scene
