// SPDX-License-Identifier: Apache-2.0
//
// A glTF file's materials: what of them kage draws, and how many have what it does not draw.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <vector>

#include "gltf_file.hpp"
#include "raw.hpp"

namespace kage::scene {

class GltfMaterials {
 public:
  /// Give `p` the material that `primitive` names, or the format's own where it names none.
  void read(const GltfFile& file, const GltfJson::Json& primitive, RawPrimitive& p, const std::string& place);

  /// Sentences on what is not drawn as the file has it.
  void note(std::vector<std::string>& notes) const;

  /// Count the materials into `contents`.
  void count(SceneContents& contents) const;

 private:
  struct Material {
    glm::dvec3 color{1, 1, 1};
    double alpha = 1;
    bool unlit = false;
    bool glows = false;  // its colour is its own light, which the vertices' colours do not change
    bool double_sided = false;
    // Features that are not drawn:
    bool masked = false;
    bool emits = false;
    bool glossy = false;
    bool unseen = false;            // all light passes through
    bool beyond = false;            // its alpha or transmissionFactor is not 0 to 1
    std::string mode;               // an unknown alphaMode
    std::size_t lost_textures = 0;  // that the file does not have
  };
  static Material material(const GltfFile& file, const GltfJson::Json& json, const std::string& here);
  static void read_emission(const GltfFile& file, const GltfJson::Json& json, Material& m, const std::string& here);
  static void read_gloss(const GltfFile& file, const GltfJson::Json& json, Material& m, const std::string& here);

  std::map<std::uint64_t, Material> materials_;
  bool default_used_ = false;
};

}  // namespace kage::scene
