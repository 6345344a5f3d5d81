// SPDX-License-Identifier: Apache-2.0
#include "gltf_meshes.hpp"

#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace kage::scene {

std::int32_t GltfMeshes::read(std::uint64_t index, const std::string& asker) {
  if (const auto known = mesh_of_.find(index); known != mesh_of_.end()) return known->second;
  const std::string place = "mesh " + std::to_string(index);
  const Json& json = file_->item("meshes", index, asker);
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
  // The same data stand in the file without compression where it does not require the extension, or nothing does.
  constexpr const char* kDraco = "KHR_draco_mesh_compression";
  if (file_->has_extension(json, kDraco, place) && !file_->has_data(*position, place))
    file_->fail(place, std::string("is compressed by Draco (") + kDraco + "), which is not read");
  RawPrimitive p;
  p.positions = file_->floats(*position, GltfUse::position, place).values;
  if (const auto normal = file_->integer(attributes, "NORMAL", place)) {
    p.normals = file_->floats(*normal, GltfUse::normal, place).values;
    if (p.normals.size() != p.positions.size()) file_->fail(place, "has more or fewer normals than positions");
  }
  if (const auto color = file_->integer(attributes, "COLOR_0", place)) {
    const GltfFile::Floats c = file_->floats(*color, GltfUse::color, place);
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
  read_joints(attributes, p, place);
  read_targets(json, p, place);
  if (!mesh.primitives.empty() && mesh.primitives[0].targets.size() != p.targets.size())
    file_->fail(place, "has not as many morph targets as the mesh's first primitive");
  materials_.read(*file_, json, p, place);
  colors_.add(p);
  read_corners(json, p, place);
  mesh.primitives.push_back(std::move(p));
}

/// JOINTS_0 and WEIGHTS_0, and further sets, four to a set, as one.
void GltfMeshes::read_joints(const Json& attributes, RawPrimitive& p, const std::string& place) {
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<std::vector<float>> weights;
  for (std::size_t set = 0;; ++set) {
    const auto of_joints = file_->integer(attributes, ("JOINTS_" + std::to_string(set)).c_str(), place);
    const auto of_weights = file_->integer(attributes, ("WEIGHTS_" + std::to_string(set)).c_str(), place);
    if (!of_joints && !of_weights) break;
    if (!of_joints || !of_weights) file_->fail(place, "has joints without weights, or weights without joints");
    joints.push_back(file_->indices(*of_joints, GltfUse::joints, place));
    weights.push_back(file_->floats(*of_weights, GltfUse::weights, place).values);
    if (joints.back().size() != 4 * p.vertex_count() || weights.back().size() != 4 * p.vertex_count())
      file_->fail(place, "has more or fewer joints or weights than positions");
    for (const float w : weights.back())
      if (!(w >= 0) || !std::isfinite(w)) file_->fail(place, "a joint's weight is negative or not finite");
  }
  for (std::size_t v = 0; v < p.vertex_count(); ++v)
    for (std::size_t set = 0; set < joints.size(); ++set)
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k) {
        p.joints.push_back(joints[set][k]);
        p.weights.push_back(weights[set][k]);
      }
}

void GltfMeshes::read_targets(const Json& json, RawPrimitive& p, const std::string& place) {
  const Json& targets = file_->array(json, "targets", place);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const std::string here = place + " target " + std::to_string(t);
    if (!targets[t].is_object()) file_->fail(here, "not an object");
    RawTarget target;
    for (const auto& [key, use, to] :
         {std::tuple{"POSITION", GltfUse::position, &target.positions}, {"NORMAL", GltfUse::normal, &target.normals}}) {
      const auto accessor = file_->integer(targets[t], key, here);
      if (!accessor) continue;
      *to = file_->floats(*accessor, use, here).values;
      if (to->size() != p.positions.size()) file_->fail(here, "has more or fewer values than the primitive positions");
      for (const float v : *to)
        if (!std::isfinite(v)) file_->fail(here, "holds what is not finite");
    }
    p.targets.push_back(std::move(target));
  }
}

std::vector<double> GltfMeshes::weights(const Json& json, std::uint64_t index, std::int32_t number,
                                        const std::string& place) const {
  const std::vector<RawPrimitive>& primitives = scene_->meshes[static_cast<std::size_t>(number)].primitives;
  const std::size_t targets = primitives.empty() ? 0 : primitives[0].targets.size();
  if (targets == 0) {
    (void)file_->has(json, "weights");
    return {};
  }
  const Json& mesh = file_->item("meshes", index, place);
  const std::vector<double> of_mesh = file_->numbers(mesh, "weights", targets, "mesh " + std::to_string(index));
  const std::vector<double> own = file_->numbers(json, "weights", targets, place);
  return !own.empty() ? own : !of_mesh.empty() ? of_mesh : std::vector<double>(targets, 0);
}

void GltfMeshes::read_corners(const Json& json, RawPrimitive& p, const std::string& place) {
  const std::uint64_t mode = file_->integer(json, "mode", place).value_or(4);
  std::vector<std::uint32_t> order;
  if (const auto indices = file_->integer(json, "indices", place)) {
    order = file_->indices(*indices, GltfUse::indices, place);
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
