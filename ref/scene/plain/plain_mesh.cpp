// SPDX-License-Identifier: Apache-2.0
#include "scene/plain/plain_mesh.hpp"

#include <utility>

#include "number/counted.hpp"
#include "scene/polygon.hpp"

namespace kage::scene {
namespace {

void push(std::vector<float>& to, const std::vector<float>& from, std::size_t vertex) {
  to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(3 * vertex),
            from.begin() + static_cast<std::ptrdiff_t>(3 * vertex + 3));
}

/// The mesh with vertices of its own for each face, all in the face's colour.
PlainMesh apart(const PlainMesh& mesh) {
  PlainMesh out;
  for (std::size_t face = 0, at = 0; face < mesh.face_count(); ++face)
    for (; at < mesh.ends[face]; ++at) {
      const std::size_t vertex = mesh.corners[at];
      push(out.positions, mesh.positions, vertex);
      if (!mesh.normals.empty()) push(out.normals, mesh.normals, vertex);
      push(out.colors, mesh.face_colors, face);
      out.corners.push_back(static_cast<std::uint32_t>(at));
    }
  out.ends = mesh.ends;
  out.name = mesh.name;
  out.double_sided = mesh.double_sided;
  return out;
}

}  // namespace

void append_face(RawPrimitive& p, std::span<const std::uint32_t> vertices, FaceCounts& counts) {
  counts.thin += vertices.size() < 3 ? 1 : 0;
  if (vertices.size() < 3) return;
  if (vertices.size() == 3) {
    p.corners.insert(p.corners.end(), vertices.begin(), vertices.end());
    p.faces.push_back(p.face_count++);
    return;
  }
  std::vector<glm::dvec3> corners;
  for (const std::size_t v : vertices)
    corners.emplace_back(p.positions[3 * v], p.positions[3 * v + 1], p.positions[3 * v + 2]);
  counts.crossing += crosses_itself(corners) ? 1 : 0;
  for (const auto& triangle : triangulate(corners)) {
    for (const std::uint32_t k : triangle) p.corners.push_back(vertices[k]);
    p.faces.push_back(p.face_count);
  }
  ++p.face_count;
}

void append(const PlainMesh& mesh, RawScene& scene, FaceCounts& counts) {
  if (!mesh.face_colors.empty()) return append(apart(mesh), scene, counts);
  RawPrimitive p;
  p.color = mesh.colors.empty() ? glm::dvec3(mesh.color) : glm::dvec3(1);
  p.double_sided = mesh.double_sided;
  p.positions = mesh.positions;
  p.normals = mesh.normals;
  p.colors = mesh.colors;
  for (std::size_t face = 0, first = 0; face < mesh.face_count(); first = mesh.ends[face++])
    append_face(p, std::span(mesh.corners).subspan(first, mesh.ends[face] - first), counts);
  RawNode node;
  node.name = mesh.name;
  node.mesh = static_cast<std::int32_t>(scene.meshes.size());
  scene.nodes.push_back(std::move(node));
  scene.meshes.push_back({mesh.name, {std::move(p)}});
  SceneContents& c = scene.contents;
  c.materials = 1;
  c.says_sides = mesh.double_sided;
  c.single_sided = mesh.double_sided ? 0 : 1;
}

void note_faces(const FaceCounts& counts, std::vector<std::string>& notes) {
  if (counts.thin > 0) notes.push_back(counted(counts.thin, "point or line is", "points or lines are") + " ignored");
  note_crossing(counts.crossing, notes);
}

void note_range(std::size_t bright, std::size_t dark, std::vector<std::string>& notes) {
  if (bright > 0) notes.push_back(counted(bright, "colour is", "colours are") + " above 1, and taken as 1");
  if (dark > 0) notes.push_back(counted(dark, "colour is", "colours are") + " below 0, and taken as 0");
}

void note_alpha(std::size_t colors, std::vector<std::string>& notes) {
  if (colors > 0)
    notes.push_back(counted(colors, "colour has", "colours have") +
                    " alpha of their own, which is ignored: the material's is used");
}

}  // namespace kage::scene
