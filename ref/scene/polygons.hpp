// SPDX-License-Identifier: Apache-2.0
//
// Faces of convex bodies as polygons: files carry triangles, so what lies in one plane and looks the same is put
// together again.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kage/scene.hpp"
#include "topology.hpp"

namespace kage::scene {

/// Share of a body's size (the diagonal of its bounding box) that a corner of a polygon may lie off the plane of the
/// polygon's first triangle. As for convexity: what single precision leaves of a plane.
inline constexpr double kPlanarTolerance = kConvexTolerance;

/// Properties of a triangle's material besides its colour.
struct Surface {
  std::uint8_t alpha = 255;
  bool unlit = false;
  Sides sides = Sides::both;

  bool operator==(const Surface&) const = default;
};

/// Append the polygons of a component to `polygons` and their corners to `corners`. In a convex closed component,
/// triangles that share an edge are put together under these conditions:
/// - each has one colour and one normal, and these are the same, up to rounding, in all of them,
/// - they are of the same surface (`surfaces`, of each triangle),
/// - they lie in the plane of the largest.
///
/// Any other triangle is a polygon of its own. `first` is the number of the component's first triangle; polygons are in
/// the order of their lowest triangle.
void append_polygons(const std::vector<glm::dvec3>& positions, std::span<const Corners> triangles,
                     std::span<const Corners> shading_corners, const std::vector<ShadingVertex>& shading,
                     std::span<const Surface> surfaces, std::uint32_t first, bool convex,
                     std::vector<Polygon>& polygons, std::vector<std::uint32_t>& corners);

}  // namespace kage::scene
