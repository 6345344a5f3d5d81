// SPDX-License-Identifier: Apache-2.0
//
// Components of a mesh: which triangles hang together, whether they are closed, and which way round they face. All in
// object space, once a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace kage::scene {

using Corners = std::array<std::uint32_t, 3>;

/// Why a component is not closed or not convex.
struct Reason {
  enum class Kind : std::uint8_t {
    kNone,
    kOneFace,        ///< edge a-b belongs to one face only
    kManyFaces,      ///< edge a-b belongs to n faces
    kNoOrientation,  ///< around edge a-b the faces cannot all face outward
    kFlat,           ///< volume 0
    kConcaveEdge,    ///< the faces at edge a-b make a hollow
    kOutside,        ///< vertex a lies outside the plane of triangle n of the component
    kLarge,          ///< more work than the test's limit
    kWound,          ///< it surrounds its inside more than once
    kMoved,          ///< its vertices move by themselves
  };
  Kind kind = Kind::kNone;
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t n = 0;

  /// One sentence. The numbers of the mesh's first vertex and of the component's first triangle are added, so that what
  /// is named can be found in SceneFrame.
  [[nodiscard]] std::string text(std::uint32_t first_vertex, std::uint32_t first_triangle) const;
};

/// Triangles [first, first + count) of a mesh, joined by shared edges.
struct MeshComponent {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool closed = false;
  bool convex = false;
  bool translucent = false;
  Reason reason;
  std::uint32_t first_polygon = 0;  ///< of its faces as polygons
  std::uint32_t polygon_count = 0;
};

/// Two triangles that share an edge, and the vertices of each that are not on it.
struct SharedEdge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t triangle[2] = {0, 0};
};

/// Number equal positions equally, in order of first appearance. `positions`: x, y, z, ...; -0 equals 0.
/// Returns for each position its number; `unique` gets the positions by number.
std::vector<std::uint32_t> weld(const std::vector<float>& positions, std::vector<glm::dvec3>& unique);

struct Topology {
  std::vector<std::uint32_t> order;  ///< triangles by component, components by their first triangle
  std::vector<bool> reversed;        ///< for each triangle of the input: its winding is to be reversed
  std::vector<MeshComponent> components;
  std::uint32_t turned = 0;      ///< triangles reversed to agree with their neighbours
  std::uint32_t inside_out = 0;  ///< closed components turned outward
};

/// Find components, orient the closed ones and test them for convexity. No triangle repeats a vertex. `budget` is how
/// many distances of a vertex from a plane may still be computed; it shrinks.
Topology analyse(const std::vector<glm::dvec3>& positions, const std::vector<Corners>& triangles,
                 std::uint64_t& budget);

/// For a closed component facing outward, `edges` being all of its edges: none if it is convex, or why not.
/// Tolerance, cost and limits: docs/scenes.md.
Reason convexity(const std::vector<glm::dvec3>& positions, const std::vector<Corners>& triangles,
                 const std::vector<SharedEdge>& edges, std::uint64_t& budget);

/// Distances that one component and one scene may take.
inline constexpr std::uint64_t kComponentBudget = std::uint64_t{1} << 28;
inline constexpr std::uint64_t kSceneBudget = std::uint64_t{1} << 31;

/// Share of a component's size (the diagonal of its bounding box) that a vertex may lie outside a face's plane.
inline constexpr double kConvexTolerance = 1e-6;

}  // namespace kage::scene
