// SPDX-License-Identifier: Apache-2.0
#include "gltf_notes.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "notes.hpp"
#include "number/counted.hpp"

namespace kage::scene {
namespace {

using Json = GltfJson::Json;

// More names than these tell a person no more.
constexpr std::size_t kMostNames = 8;

enum class Kind {
  drawn,
  texture,  // concerns textures alone, none of which is drawn: a file that requires it is drawn all the same
  about,    // says something about the file, and changes no picture
  packed,   // the meshes cannot be read without it
};

struct Extension {
  std::string_view name;
  Kind kind;
};

// All others are not known: https://github.com/KhronosGroup/glTF/tree/main/extensions has the list.
constexpr std::array kExtensions{
    Extension{"KHR_lights_punctual", Kind::drawn},
    Extension{"KHR_materials_emissive_strength", Kind::drawn},
    Extension{"KHR_materials_pbrSpecularGlossiness", Kind::drawn},
    Extension{"KHR_materials_transmission", Kind::drawn},
    Extension{"KHR_materials_unlit", Kind::drawn},
    Extension{"KHR_mesh_quantization", Kind::drawn},
    Extension{"KHR_node_visibility", Kind::drawn},
    Extension{"EXT_texture_avif", Kind::texture},
    Extension{"EXT_texture_webp", Kind::texture},
    Extension{"KHR_texture_basisu", Kind::texture},
    Extension{"KHR_texture_transform", Kind::texture},
    Extension{"MSFT_texture_dds", Kind::texture},
    Extension{"KHR_xmp", Kind::about},
    Extension{"KHR_xmp_json_ld", Kind::about},
    Extension{"EXT_meshopt_compression", Kind::packed},
    Extension{"KHR_draco_mesh_compression", Kind::packed},
    Extension{"KHR_meshopt_compression", Kind::packed},
};

const Extension* known(std::string_view name) {
  const auto* const at =
      std::find_if(kExtensions.begin(), kExtensions.end(), [&](const Extension& e) { return e.name == name; });
  return at == kExtensions.end() ? nullptr : at;
}

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }
bool ends(std::string_view text, std::string_view with) {
  return text.size() >= with.size() && text.substr(text.size() - with.size()) == with;
}

// Keys that may be passed over without a word: they change no picture, or belong to something of which another
// sentence speaks (textures, masks). docs/scenes.md lists them.
bool is_silent(std::string_view way) {
  constexpr std::array<std::string_view, 11> kSilent{"accessors/max",
                                                     "accessors/min",
                                                     "bufferViews/target",
                                                     "images",
                                                     "materials/alphaCutoff",
                                                     "meshes/weights",
                                                     "samplers",
                                                     "skins",
                                                     "textures",
                                                     "skins/skeleton",
                                                     "extensionsUsed"};
  constexpr std::string_view kAttributes = "meshes/primitives/attributes/";
  if (std::find(kSilent.begin(), kSilent.end(), way) != kSilent.end()) return true;
  if (begins(way, "asset/") || begins(way, "meshes/primitives/targets/TEXCOORD_") ||
      way == "meshes/primitives/targets/TANGENT" || way == "name" || ends(way, "/name") || ends(way, "Texture"))
    return true;
  if (!begins(way, kAttributes)) return false;
  const std::string_view attribute = way.substr(kAttributes.size());
  return begins(attribute, "TEXCOORD_") || attribute == "TANGENT" || begins(attribute, "_");
}

void note_names(const std::vector<std::string>& names, const char* one, const char* many,
                std::vector<std::string>& notes) {
  if (names.empty()) return;
  std::string text = counted(names.size(), one, many);
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
    text += (i == 0 ? " " : ", ") + one_line(names[i], 80);
  if (names.size() > kMostNames) text += " and " + std::to_string(names.size() - kMostNames) + " more";
  notes.push_back(std::move(text));
}

}  // namespace

void refuse_required(const GltfJson& file) {
  for (const Json& e : file.array(file.root(), "extensionsRequired", "JSON")) {
    if (!e.is_string()) file.fail("extensionsRequired", "holds what is not a text");
    const std::string name = e.get<std::string>();
    const Extension* const extension = known(name);
    if (extension == nullptr)
      file.fail("extensionsRequired",
                "the file cannot be drawn without " + one_line(name, 80) + ", which kage does not know");
    if (extension->kind == Kind::packed)
      file.fail("extensionsRequired", "meshes compressed by " + name + " are not read");
  }
}

void note_unknown(const GltfJson& file, const std::set<std::string>& told, std::vector<std::string>& notes) {
  std::vector<std::string> names;
  for (const std::string& name : file.extensions()) {
    const Extension* const extension = known(name);
    const bool quiet = extension != nullptr && (extension->kind == Kind::drawn || extension->kind == Kind::about);
    if (!quiet && told.count(name) == 0) names.push_back(name);
  }
  note_names(names, "extension is ignored:", "extensions are ignored:", notes);
  names.clear();
  for (const auto& [way, count] : file.unread()) {
    // An extension that is drawn is a key like others where it stands at a place at which kage does not look for it.
    const std::size_t at = way.rfind("extensions/");
    const bool extension = at != std::string::npos && way.find('/', at + 11) == std::string::npos;
    const Extension* const drawn = extension ? known(std::string_view(way).substr(at + 11)) : nullptr;
    if (extension ? drawn != nullptr && drawn->kind == Kind::drawn : !is_silent(way)) names.push_back(way);
  }
  note_names(names, "key is ignored, which kage does not know:", "keys are ignored, which kage does not know:", notes);
}

}  // namespace kage::scene
