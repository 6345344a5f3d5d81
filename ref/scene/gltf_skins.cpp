// SPDX-License-Identifier: Apache-2.0
#include "gltf_skins.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace kage::scene {
namespace {

bool has_joints(const RawMesh& mesh) {
  return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                     [](const RawPrimitive& p) { return !p.joints.empty(); });
}

}  // namespace

std::int32_t GltfSkins::skin(std::uint64_t index, const std::string& asker, const GltfAnimation::NodeNumbers& node_of) {
  if (const auto known = skin_of_.find(index); known != skin_of_.end()) return known->second;
  const GltfJson::Json& json = file_->item("skins", index, asker);
  const std::string place = "skin " + std::to_string(index);
  RawSkin skin;
  for (const GltfJson::Json& joint : file_->array(json, "joints", place)) {
    if (!joint.is_number_unsigned()) file_->fail(place, "'joints' holds what is not a number");
    const auto node = node_of.find(joint.get<std::uint64_t>());
    if (node == node_of.end())
      file_->fail(place, "joint node " + std::to_string(joint.get<std::uint64_t>()) + " is not in the scene");
    skin.joints.push_back(node->second);
  }
  if (skin.joints.empty()) file_->fail(place, "has no joints");
  if (const auto matrices = file_->integer(json, "inverseBindMatrices", place))
    skin.inverse = file_->affine_maps(*matrices, place);
  else
    skin.inverse.resize(skin.joints.size());
  if (skin.inverse.size() < skin.joints.size()) file_->fail(place, "has fewer inverse bind matrices than joints");
  const auto number = static_cast<std::int32_t>(scene_->skins.size());
  scene_->skins.push_back(std::move(skin));
  skin_of_.emplace(index, number);
  return number;
}

void GltfSkins::read(const GltfAnimation::NodeNumbers& node_of) {
  for (const Asked& asked : asked_) {
    RawNode& node = scene_->nodes[asked.node];
    const std::int32_t number = skin(asked.skin, asked.place, node_of);
    const RawMesh& mesh = scene_->meshes[static_cast<std::size_t>(node.mesh)];
    if (!has_joints(mesh)) {
      ++counts_.idle;
      continue;
    }
    check(mesh, scene_->skins[static_cast<std::size_t>(number)], asked.place);
    node.skin = number;
  }
}

/// A joint that the skin does not have may be named where its weight is 0.
void GltfSkins::check(const RawMesh& mesh, const RawSkin& skin, const std::string& place) {
  const auto check_joint = [&](std::uint32_t joint) {
    if (joint < skin.joints.size()) return;
    file_->fail(place, "its mesh names joint " + std::to_string(joint) + " of " + std::to_string(skin.joints.size()));
  };
  for (const RawPrimitive& p : mesh.primitives) {
    const std::size_t influences = p.vertex_count() == 0 ? 0 : p.joints.size() / p.vertex_count();
    counts_.weightless += influences == 0 ? p.vertex_count() : 0;
    for (std::size_t v = 0; influences > 0 && v < p.vertex_count(); ++v) {
      float sum = 0;
      for (std::size_t k = v * influences; k < (v + 1) * influences; ++k) {
        sum += p.weights[k];
        if (p.weights[k] > 0) check_joint(p.joints[k]);
      }
      if (sum > 0) continue;
      ++counts_.weightless;
      check_joint(p.joints[v * influences]);
    }
  }
}

void GltfSkins::drop_unmoved() {
  std::set<std::int32_t> moved;
  for (const RawNode& node : scene_->nodes)
    if (node.skin >= 0 || std::any_of(node.weights.begin(), node.weights.end(), [](double w) { return w != 0; }))
      moved.insert(node.mesh);
  for (const RawTrack& track : scene_->tracks)
    if (track.path == RawPath::kWeights) moved.insert(scene_->nodes[track.node].mesh);
  for (std::size_t i = 0; i < scene_->meshes.size(); ++i) {
    if (moved.count(static_cast<std::int32_t>(i)) > 0) continue;
    for (RawPrimitive& p : scene_->meshes[i].primitives) p.joints.clear(), p.weights.clear(), p.targets.clear();
  }
}

}  // namespace kage::scene
