// SPDX-License-Identifier: Apache-2.0
#include "gltf_materials.hpp"

#include <algorithm>
#include <string_view>

#include "notes.hpp"
#include "number/counted.hpp"

namespace kage::scene {
namespace {

using Json = GltfJson::Json;

const Json& gloss_of(const GltfFile& file, const Json& material, const std::string& here) {
  return file.extension(material, "KHR_materials_pbrSpecularGlossiness", here);
}

/// Number of references to textures that the file does not have, wherever in the material they stand. Textures are not
/// drawn, so the references do not count as read.
std::size_t lost_textures(const GltfFile& file, const Json& material) {
  const std::size_t textures = file.count("textures");
  const auto is_lost = [textures](const std::string& key, const Json& value) {
    const std::string_view kind = "Texture";
    if (key.size() < kind.size() || key.compare(key.size() - kind.size(), kind.size(), kind) != 0) return false;
    const auto index = value.is_object() ? value.find("index") : value.end();
    return value.is_object() && index != value.end() &&
           (!index->is_number() || index->get<double>() < 0 || index->get<double>() >= static_cast<double>(textures));
  };
  std::size_t lost = 0;
  std::vector<const Json*> waiting{&material};
  while (!waiting.empty()) {
    const Json& value = *waiting.back();
    waiting.pop_back();
    if (!value.is_object()) continue;
    for (const auto& [key, member] : value.items()) {
      if (key == "extras") continue;
      lost += is_lost(key, member) ? 1 : 0;
      waiting.push_back(&member);
    }
  }
  return lost;
}

bool is_share(double v) { return v >= 0 && v <= 1; }

}  // namespace

GltfMaterials::Material GltfMaterials::material(const GltfFile& file, const Json& json, const std::string& here) {
  Material m;
  std::vector<double> factor =
      file.numbers(file.object(json, "pbrMetallicRoughness", here), "baseColorFactor", 4, here);
  const std::vector<double> diffuse = file.numbers(gloss_of(file, json, here), "diffuseFactor", 4, here);
  if (factor.empty()) factor = diffuse;
  if (factor.empty()) factor = {1, 1, 1, 1};
  m.color = vec3(factor);
  const std::string mode = file.text(json, "alphaMode", here);
  if (mode == "BLEND") m.alpha = std::clamp(factor[3], 0.0, 1.0);
  m.masked = mode == "MASK";
  if (!mode.empty() && mode != "BLEND" && mode != "MASK" && mode != "OPAQUE") m.mode = mode;
  const Json& through = file.extension(json, "KHR_materials_transmission", here);
  const double given = file.number(through, "transmissionFactor", here).value_or(0);
  const double transmitted = std::clamp(given, 0.0, 1.0);
  m.beyond = !is_share(given) || (mode == "BLEND" && !is_share(factor[3]));
  m.alpha *= 1 - transmitted;
  m.unseen = transmitted > 0 && m.alpha < 0.5 / 255;
  m.double_sided = file.boolean(json, "doubleSided", false, here);
  m.unlit = file.has_extension(json, "KHR_materials_unlit", here);
  read_emission(file, json, m, here);
  read_gloss(file, json, m, here);
  m.lost_textures = lost_textures(file, json);
  return m;
}

// A black surface shows nothing but its own light, which no other light or shadow changes. An unlit material's other
// members, besides its base colour, are for readers that do not know the extension.
void GltfMaterials::read_emission(const GltfFile& file, const Json& json, Material& m, const std::string& here) {
  const std::vector<double> factor = file.numbers(json, "emissiveFactor", 3, here);
  const Json& strength = file.extension(json, "KHR_materials_emissive_strength", here);
  const double times = file.number(strength, "emissiveStrength", here).value_or(1);
  if (m.unlit || factor.empty() || vec3(factor) == glm::dvec3(0) || times == 0) return;
  m.glows = m.color == glm::dvec3(0);
  m.emits = !m.glows;
  if (!m.glows) return;
  m.unlit = true;
  m.color = vec3(factor) * times;
}

void GltfMaterials::read_gloss(const GltfFile& file, const Json& json, Material& m, const std::string& here) {
  const Json& metal = file.object(json, "pbrMetallicRoughness", here);
  const double roughness = file.number(metal, "roughnessFactor", here).value_or(1);
  const Json& gloss = gloss_of(file, json, here);
  // The format's own default is metal, but for a material that says it in the other way.
  const double metalness = file.number(metal, "metallicFactor", here).value_or(gloss.empty() ? 1 : 0);
  const double glossiness = file.number(gloss, "glossinessFactor", here).value_or(0);
  const std::vector<double> specular = file.numbers(gloss, "specularFactor", 3, here);
  const bool shines =
      metalness > 0 || roughness < 1 || glossiness > 0 || (!specular.empty() && vec3(specular) != glm::dvec3(0));
  m.glossy = shines && !m.unlit;
}

void GltfMaterials::read(const GltfFile& file, const Json& primitive, RawPrimitive& p, const std::string& place) {
  const auto index = file.integer(primitive, "material", place);
  Material m;
  if (index) {
    const Json& json = file.item("materials", *index, place);
    const auto [at, fresh] = materials_.try_emplace(*index);
    if (fresh) at->second = material(file, json, "material " + std::to_string(*index));
    m = at->second;
  } else {
    default_used_ = true;
  }
  p.color = m.color;
  p.alpha = m.alpha;
  p.unlit = m.unlit;
  p.double_sided = m.double_sided;
  if (m.glows) p.colors.clear();
}

void GltfMaterials::note(std::vector<std::string>& notes) const {
  const auto add = [&](auto which, const char* one, const char* many, const char* rest) {
    const auto n = std::count_if(materials_.begin(), materials_.end(), [&](const auto& m) { return which(m.second); });
    if (n > 0) notes.push_back(counted(static_cast<std::size_t>(n), one, many) + rest);
  };
  add([](const Material& m) { return m.masked; }, "material has", "materials have",
      " an alpha mask, which is ignored: drawn opaque");
  std::size_t lost = 0;
  for (const auto& [index, m] : materials_) lost += m.lost_textures;
  if (lost > 0)
    notes.push_back(counted(lost, "reference to a texture", "references to textures") +
                    (lost == 1 ? " that is not in the file is" : " that are not in the file are") + " ignored");
  for (const auto& [index, m] : materials_)
    if (!m.mode.empty())
      notes.push_back("material " + std::to_string(index) + ": alphaMode '" + one_line(m.mode, 40) +
                      "' is unknown, and ignored: drawn opaque");
  add([](const Material& m) { return m.beyond; }, "material has", "materials have",
      " an alpha or a transmissionFactor that is not 0 to 1: the nearest that is, is taken");
  add([](const Material& m) { return m.unseen; }, "material lets", "materials let",
      " all light through (transmissionFactor), and cannot be seen");
  add([](const Material& m) { return m.emits; }, "material emits", "materials emit",
      " light, which is ignored: its base colour is not black");
  add([](const Material& m) { return m.glossy; }, "material is", "materials are",
      " metallic or glossy, which is ignored: drawn matt");
}

void GltfMaterials::count(SceneContents& contents) const {
  contents.materials = static_cast<std::uint32_t>(materials_.size()) + (default_used_ ? 1 : 0);
  contents.single_sided = default_used_ ? 1 : 0;
  for (const auto& [index, m] : materials_) {
    contents.translucent += m.alpha < 1 ? 1 : 0;
    contents.unlit += m.unlit ? 1 : 0;
    contents.single_sided += m.double_sided ? 0 : 1;
  }
}

}  // namespace kage::scene
