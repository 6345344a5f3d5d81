// SPDX-License-Identifier: Apache-2.0
//
// A mesh in object space, ready to be drawn by any number of nodes: welded, split into components, oriented, with what
// shading needs at each corner.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "deform.hpp"
#include "kage/scene.hpp"
#include "polygons.hpp"
#include "raw.hpp"
#include "topology.hpp"

namespace kage::scene {

struct Mesh {
  std::vector<glm::dvec3> vertices;
  std::vector<ShadingVertex> shading;
  std::vector<Corners> triangles;        ///< corners into vertices, by component
  std::vector<Corners> shading_corners;  ///< corners into shading
  std::vector<std::uint32_t> faces;      ///< the file's face of each triangle
  std::vector<Surface> surfaces;         ///< of each triangle
  std::vector<MeshComponent> components;
  std::vector<Polygon> polygons;       ///< of the components, in their order
  std::vector<std::uint32_t> corners;  ///< of polygons, into vertices
  bool has_area = false;               ///< some triangle's area is not 0: there is something to see
  bool smooth = false;                 ///< shading differs between corners of some triangle
  std::optional<Motion> motion;        ///< its vertices move by themselves: none of its components is convex

  std::uint32_t dropped = 0;      ///< triangles left out because they repeat a vertex
  std::uint32_t turned = 0;       ///< triangles reversed to agree with their neighbours
  std::uint32_t inside_out = 0;   ///< closed components turned outward
  std::uint32_t bad_normals = 0;  ///< normals that are 0 or not finite
};

Mesh build_mesh(const RawMesh& raw, std::uint64_t& budget);

}  // namespace kage::scene
