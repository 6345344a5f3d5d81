// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>
#include <span>
#include <vector>

#include "kage/order.hpp"
#include "kage/scene.hpp"

namespace kage {

/// Polygons of a frame for an OrderTree, numbered as in `polygons`, with the vertices that they have.
inline OrderMesh order_mesh(const SceneFrame& frame, std::span<const std::uint32_t> polygons) {
  OrderMesh mesh;
  mesh.polygons.reserve(polygons.size());
  std::vector<std::uint32_t> number(frame.vertices.size(), ~0U);
  for (const std::uint32_t p : polygons) {
    const auto outline = frame.outline(frame.polygons[p]);
    mesh.polygons.push_back(
        {static_cast<std::uint32_t>(mesh.corners.size()), static_cast<std::uint32_t>(outline.size())});
    for (const std::uint32_t v : outline) {
      if (number[v] == ~0U) {
        number[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back({frame.vertices[v].x, frame.vertices[v].y, frame.vertices[v].z});
      }
      mesh.corners.push_back(number[v]);
    }
  }
  return mesh;
}

/// All of them.
inline OrderMesh order_mesh(const SceneFrame& frame) {
  std::vector<std::uint32_t> all(frame.polygons.size());
  std::iota(all.begin(), all.end(), 0U);
  return order_mesh(frame, all);
}

}  // namespace kage
