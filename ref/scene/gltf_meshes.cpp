// SPDX-License-Identifier: Apache-2.0
#include "gltf_meshes.hpp"

#include <array>
#include <utility>
#include <vector>

namespace kage::scene {

std::int32_t GltfMeshes::read(std::uint64_t index) {
  if (const auto known = mesh_of_.find(index); known != mesh_of_.end()) return known->second;
  const std::string place = "mesh " + std::to_string(index);
  const Json& json = file_->item("meshes", index, place);
  RawMesh mesh;
  mesh.name = file_->text(json, "name", place);
  if (mesh.name.empty()) mesh.name = std::to_string(index);
  const Json& primitives = file_->array(json, "primitives", place);
  for (std::size_t k = 0; k < primitives.size(); ++k) {
    const std::string here = place + " primitive " + std::to_string(k);
    if (!primitives[k].is_object()) file_->fail(here, "not an object");
    read_primitive(primitives[k], mesh, here);
  }
  const auto number = static_cast<std::int32_t>(scene_->meshes.size());
  scene_->meshes.push_back(std::move(mesh));
  mesh_of_.emplace(index, number);
  return number;
}

void GltfMeshes::read_primitive(const Json& json, RawMesh& mesh, const std::string& place) {
  const std::uint64_t mode = file_->integer(json, "mode", place).value_or(4);
  if (mode > 6) file_->fail(place, "mode " + std::to_string(mode) + " is unknown");
  const Json& attributes = file_->object(json, "attributes", place);
  const auto position = file_->integer(attributes, "POSITION", place);
  if (mode < 4 || !position) {
    ++(mode < 4 ? counts_.thin : counts_.bare);
    file_->pass_over(json);
    return;
  }
  if (!file_->array(json, "targets", place).empty()) ++counts_.morphs;
  RawPrimitive p;
  p.positions = file_->floats(*position, 3, 3, place).values;
  if (const auto normal = file_->integer(attributes, "NORMAL", place)) {
    p.normals = file_->floats(*normal, 3, 3, place).values;
    if (p.normals.size() != p.positions.size()) file_->fail(place, "has more or fewer normals than positions");
  }
  if (const auto color = file_->integer(attributes, "COLOR_0", place)) {
    const GltfFile::Floats c = file_->floats(*color, 3, 4, place);
    if (c.values.size() / c.components != p.vertex_count())
      file_->fail(place, "has more or fewer colours than positions");
    bool translucent = false;
    for (std::size_t i = 0; i < c.values.size(); ++i)
      if (i % c.components < 3)
        p.colors.push_back(c.values[i]);
      else
        translucent = translucent || c.values[i] < 1;
    counts_.alpha += translucent ? 1 : 0;
  }
  materials_.read(*file_, json, p, place);
  read_corners(json, p, place);
  mesh.primitives.push_back(std::move(p));
}

void GltfMeshes::read_corners(const Json& json, RawPrimitive& p, const std::string& place) {
  const std::uint64_t mode = file_->integer(json, "mode", place).value_or(4);
  std::vector<std::uint32_t> order;
  if (const auto indices = file_->integer(json, "indices", place)) {
    order = file_->indices(*indices, place);
  } else {
    order.resize(p.vertex_count());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  }
  const std::size_t triangles = mode == 4 ? order.size() / 3 : (order.size() < 3 ? 0 : order.size() - 2);
  for (std::size_t i = 0; i < triangles; ++i) {
    std::array<std::size_t, 3> at{3 * i, 3 * i + 1, 3 * i + 2};
    if (mode == 5) at = {i, i + 1 + i % 2, i + 2 - i % 2};
    if (mode == 6) at = {0, i + 1, i + 2};
    for (const std::size_t k : at) p.corners.push_back(order[k]);
    p.faces.push_back(static_cast<std::uint32_t>(i));
  }
  p.face_count = static_cast<std::uint32_t>(triangles);
}

}  // namespace kage::scene
