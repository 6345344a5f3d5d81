// SPDX-License-Identifier: Apache-2.0
// Materials by Assimp's data, as far as they are drawn.
#pragma once

#include <assimp/scene.h>

#include <set>
#include <string>

#include "scene/raw.hpp"

namespace kage::scene::mesh_plugin {

/// Refers to what it is made of.
class AssimpMaterials {
 public:
  AssimpMaterials(const aiScene& in, RawScene& scene) : in_(&in), scene_(&scene) {}

  /// Gives a primitive what material `index` says, and counts the material once.
  void read(unsigned index, RawPrimitive& p);

  /// Numbers of materials, among those that were read, that are not drawn as the file has them.
  struct Counts {
    std::size_t emitting = 0;  ///< that give light over a colour that is not black
    std::size_t glossy = 0;
    std::size_t unshaded = 0;
    std::size_t invisible = 0;  ///< of opacity 0
    std::size_t textures = 0;   ///< slots with one
  };
  [[nodiscard]] Counts counts() const;

 private:
  void read_light_of_its_own(const aiMaterial& material, RawPrimitive& p, bool fresh);

  const aiScene* in_;
  RawScene* scene_;
  std::set<unsigned> read_;
  Counts counts_;
};

}  // namespace kage::scene::mesh_plugin
