// SPDX-License-Identifier: Apache-2.0
#include "scene/plugin/assimp_materials.hpp"

#include <assimp/material.h>

#include <algorithm>

#include "scene/plugin/assimp_values.hpp"
#include "scene/space.hpp"

namespace kage::scene::mesh_plugin {
namespace {

// Several formats, and readers, say 0 and mean that nothing was said: what is drawn at all is not wholly invisible.
double opacity(const aiMaterial& material) {
  ai_real value = 1;
  if (material.Get(AI_MATKEY_OPACITY, value) != AI_SUCCESS || !(value > 0 && value < 1)) return 1;
  return static_cast<double>(value);
}

}  // namespace

void AssimpMaterials::read(unsigned index, RawPrimitive& p) {
  if (index >= in_->mNumMaterials || in_->mMaterials[index] == nullptr) return;
  const bool fresh = read_.insert(index).second;
  const aiMaterial& material = *in_->mMaterials[index];
  p.alpha = opacity(material);
  int two_sided = 0;
  if (material.Get(AI_MATKEY_TWOSIDED, two_sided) == AI_SUCCESS) {
    scene_->contents.says_sides = true;
    p.double_sided = two_sided != 0;
  }
  aiColor4D color(1, 1, 1, 1);
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS ||
      material.Get(AI_MATKEY_BASE_COLOR, color) == AI_SUCCESS) {
    const glm::dvec3 c{color.r, color.g, color.b};
    if (is_finite(c)) p.color = c;
  }
  read_light_of_its_own(material, p, fresh);
  if (!fresh) return;
  SceneContents& c = scene_->contents;
  ++c.materials;
  c.translucent += p.alpha < 1 ? 1 : 0;
  c.unlit += p.unlit ? 1 : 0;
  c.single_sided += p.double_sided ? 0 : 1;
}

// As for glTF (gltf_materials.cpp): a black surface shows its own light alone, and gloss is not drawn.
void AssimpMaterials::read_light_of_its_own(const aiMaterial& material, RawPrimitive& p, bool fresh) {
  const auto color = [&material](const char* key, unsigned type, unsigned index) {
    aiColor3D c(0, 0, 0);
    if (material.Get(key, type, index, c) != AI_SUCCESS || !is_finite(rgb(c))) return glm::dvec3(0);
    return glm::dvec3(std::max(rgb(c).x, 0.0), std::max(rgb(c).y, 0.0), std::max(rgb(c).z, 0.0));
  };
  const glm::dvec3 light = color(AI_MATKEY_COLOR_EMISSIVE);
  p.unlit = light != glm::dvec3(0) && p.color == glm::dvec3(0);
  if (p.unlit) {
    p.color = light;
    p.colors.clear();
  }
  if (!fresh || p.unlit) return;
  // Several readers say "no shading" of what is only shaded plainly, so it is not drawn like that.
  int model = aiShadingMode_Gouraud;
  (void)material.Get(AI_MATKEY_SHADING_MODEL, model);
  counts_.unshaded += model == aiShadingMode_NoShading ? 1 : 0;
  counts_.emitting += light != glm::dvec3(0) ? 1 : 0;
  counts_.glossy += color(AI_MATKEY_COLOR_SPECULAR) != glm::dvec3(0) ? 1 : 0;
}

AssimpMaterials::Counts AssimpMaterials::counts() const {
  Counts all = counts_;
  for (const unsigned i : read_) {
    const aiMaterial& m = *in_->mMaterials[i];
    for (int type = aiTextureType_NONE + 1; type <= AI_TEXTURE_TYPE_MAX; ++type)
      all.textures += m.GetTextureCount(static_cast<aiTextureType>(type));
    ai_real value = 1;
    if (m.Get(AI_MATKEY_OPACITY, value) == AI_SUCCESS && !(value > 0)) ++all.invisible;
  }
  return all;
}

}  // namespace kage::scene::mesh_plugin
