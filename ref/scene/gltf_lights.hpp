// SPDX-License-Identifier: Apache-2.0
// glTF's lights (KHR_lights_punctual), and what they extend over.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gltf_file.hpp"
#include "raw.hpp"

namespace kage::scene {

/// Refers to what it is made of.
class GltfLights {
 public:
  /// Numbers of lights that are not drawn as the file has them.
  struct Counts {
    std::size_t black = 0;
    std::size_t shaped_suns = 0;  ///< directional lights with a shape
  };

  GltfLights(GltfFile& file, RawScene& scene) : file_(&file), scene_(&scene) {}

  /// Appends light `index` of the file, which shines from `node`, to the scene's. `asker`: who names it. A defect is no
  /// reason to refuse the scene: the light shines as nearly as may be, or not at all, and a note says so.
  void read(std::uint64_t index, std::uint32_t node, const std::string& asker);

  [[nodiscard]] const Counts& counts() const { return counts_; }
  /// A sentence on each defect.
  [[nodiscard]] const std::vector<std::string>& defects() const { return defects_; }

 private:
  using Json = GltfJson::Json;

  void read_cone(const Json& json, Light& light, const std::string& place);
  void read_shape(const Json& json, Light& light, const std::string& place);

  void tell(const std::string& defect);

  GltfFile* file_;
  RawScene* scene_;
  Counts counts_;
  std::vector<std::string> defects_;
};

}  // namespace kage::scene
