// SPDX-License-Identifier: Apache-2.0
// glTF's meshes: triangles of its primitives, with their materials.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "color_range.hpp"
#include "gltf_file.hpp"
#include "gltf_materials.hpp"
#include "raw.hpp"

namespace kage::scene {

/// Refers to what it is made of.
class GltfMeshes {
 public:
  /// Numbers of primitives that are not drawn as the file has them.
  struct Counts {
    std::size_t thin = 0;   ///< points and lines
    std::size_t bare = 0;   ///< without positions
    std::size_t alpha = 0;  ///< by the colours of their vertices
  };

  GltfMeshes(GltfFile& file, RawScene& scene) : file_(&file), scene_(&scene) {}

  /// The number in the scene of mesh `index` of the file, which is appended when it is first asked for. `asker`: who
  /// names it.
  std::int32_t read(std::uint64_t index, const std::string& asker);

  /// Weights of its morph targets: those of the node `json`, which has mesh `index` of the file, `number` in the scene,
  /// else those of the mesh, else 0.
  [[nodiscard]] std::vector<double> weights(const GltfJson::Json& json, std::uint64_t index, std::int32_t number,
                                            const std::string& place) const;

  [[nodiscard]] const GltfMaterials& materials() const { return materials_; }
  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const ColorRange& colors() const { return colors_; }

 private:
  using Json = GltfJson::Json;

  void read_primitive(const Json& json, RawMesh& mesh, const std::string& place);
  void read_joints(const Json& attributes, RawPrimitive& primitive, const std::string& place);
  void read_targets(const Json& json, RawPrimitive& primitive, const std::string& place);
  void read_corners(const Json& json, RawPrimitive& primitive, const std::string& place);

  GltfFile* file_;
  RawScene* scene_;
  GltfMaterials materials_;
  std::map<std::uint64_t, std::int32_t> mesh_of_;  // file's mesh -> ours
  Counts counts_;
  ColorRange colors_;
};

}  // namespace kage::scene
