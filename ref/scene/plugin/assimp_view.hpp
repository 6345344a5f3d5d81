// SPDX-License-Identifier: Apache-2.0
// Assimp's cameras and lights.
#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <map>
#include <string>

#include "scene/raw.hpp"

namespace kage::scene::mesh_plugin {

/// Numbers in the scene of the nodes of a name, the first of that name.
using NodeNames = std::map<std::string, std::uint32_t>;

/// Refers to what it is made of.
class AssimpView {
 public:
  /// `file`: what messages call it.
  AssimpView(const aiScene& in, const NodeNames& node_of, const std::string& file, RawScene& scene)
      : in_(&in), node_of_(&node_of), file_(&file), scene_(&scene) {}

  /// The first camera becomes the scene's. Returns how many there are.
  std::size_t read_cameras();
  void read_lights();

 private:
  [[nodiscard]] std::uint32_t node_named(const std::string& name) const {
    const auto it = node_of_->find(name);
    return it == node_of_->end() ? 0 : it->second;
  }

  const aiScene* in_;
  const NodeNames* node_of_;
  const std::string* file_;
  RawScene* scene_;
};

}  // namespace kage::scene::mesh_plugin
