// SPDX-License-Identifier: Apache-2.0
// glTF's skins, and which meshes they and morph targets move.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "gltf_animation.hpp"
#include "gltf_file.hpp"
#include "raw.hpp"

namespace kage::scene {

/// Refers to what it is made of.
class GltfSkins {
 public:
  struct Counts {
    std::size_t idle = 0;        ///< nodes whose mesh has no joints, so that their skin moves nothing
    std::size_t weightless = 0;  ///< vertices without a weight
  };

  GltfSkins(GltfFile& file, RawScene& scene) : file_(&file), scene_(&scene) {}

  /// Notes that node `number` of the scene has skin `index` of the file. `place`: the node.
  void add(std::uint32_t number, std::uint64_t index, std::string place) {
    asked_.push_back({number, index, std::move(place)});
  }

  /// Appends the skins to the scene, once it has all nodes.
  void read(const GltfAnimation::NodeNumbers& node_of);

  /// Drops joints and morph targets of meshes that nothing moves, once all tracks are read.
  void drop_unmoved();

  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  struct Asked {
    std::uint32_t node;
    std::uint64_t skin;
    std::string place;
  };
  std::int32_t skin(std::uint64_t index, const std::string& asker, const GltfAnimation::NodeNumbers& node_of);
  void check(const RawMesh& mesh, const RawSkin& skin, const std::string& place);

  GltfFile* file_;
  RawScene* scene_;
  std::vector<Asked> asked_;
  std::map<std::uint64_t, std::int32_t> skin_of_;  // file's skin -> ours
  Counts counts_;
};

}  // namespace kage::scene
