// SPDX-License-Identifier: Apache-2.0
//
// The mesh that the readers of plain formats (PLY, STL, OFF) share, as these formats have it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/raw.hpp"

namespace kage::scene {

/// The colour of what has none in OBJ and OFF, in each channel. In PLY and STL it is white.
inline constexpr double kGrey = 0.6;

/// Appends a face of the file to a primitive, cut into triangles. False, and nothing happens, where it has less than
/// three corners. `vertices` are of the primitive.
bool append_face(RawPrimitive& p, std::span<const std::uint32_t> vertices);

/// Vertices, and faces of any number of corners.
struct PlainMesh {
  std::string name;
  std::vector<float> positions;        ///< x, y, z of each vertex
  std::vector<float> normals;          ///< as many, or none
  std::vector<float> colors;           ///< red, green, blue of each vertex, or none
  std::vector<std::uint32_t> corners;  ///< of all faces, into the vertices
  std::vector<std::uint32_t> ends;     ///< of each face, behind its last one in `corners`
  std::vector<float> face_colors;      ///< red, green, blue of each face, or none
  double color = kGrey;                ///< where there are none, in each channel
  bool double_sided = false;

  [[nodiscard]] std::size_t vertex_count() const { return positions.size() / 3; }
  [[nodiscard]] std::size_t face_count() const { return ends.size(); }
};

/// Appends a node with the mesh to the scene, and counts its material. Colours of faces count, where there are some,
/// not those of vertices. Returns how many faces are points or lines, which are not drawn.
std::size_t append(const PlainMesh& mesh, RawScene& scene);

/// The sentences that readers of plain formats share.
void note_thin(std::size_t count, std::vector<std::string>& notes);
void note_alpha(std::size_t colors, std::vector<std::string>& notes);

}  // namespace kage::scene
