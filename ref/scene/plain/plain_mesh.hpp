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

/// Faces that are not drawn as the file has them.
struct FaceCounts {
  std::size_t thin = 0;      ///< points and lines, which are not drawn
  std::size_t crossing = 0;  ///< whose outline crosses itself
};

/// Appends a face of the file to a primitive, cut into triangles. Nothing but the count happens where it has less than
/// three corners. `vertices` are of the primitive.
void append_face(RawPrimitive& p, std::span<const std::uint32_t> vertices, FaceCounts& counts);

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
/// not those of vertices.
void append(const PlainMesh& mesh, RawScene& scene, FaceCounts& counts);

/// The sentences that readers of plain formats share.
void note_faces(const FaceCounts& counts, std::vector<std::string>& notes);
/// `bright` colours have a channel above 1, `dark` ones one below 0.
void note_range(std::size_t bright, std::size_t dark, std::vector<std::string>& notes);
void note_alpha(std::size_t colors, std::vector<std::string>& notes);

}  // namespace kage::scene
