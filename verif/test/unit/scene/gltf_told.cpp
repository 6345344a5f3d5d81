// SPDX-License-Identifier: Apache-2.0
// What a glTF file has is drawn, or told in a note, or stands on the short list of what is silent on purpose: each
// property of glTF 2.0, each extension of the Khronos list, and keys that nobody knows, at every place.
#include <nlohmann/json.hpp>
#include <set>

#include "files.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::TempDirectory;
using Json = nlohmann::json;

namespace {

/// A file that has something of everything that is drawn.
Json base() {
  const std::string data = test::bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}) +  // positions
                           test::bytes_of(std::vector<float>{0, 1, 0, 0, 0, 1, 2, 3}) +     // times, keys
                           test::bytes_of(std::vector<std::uint16_t>{0, 1, 2, 0});          // indices
  Json doc = Json::parse(test::gltf(R"(
      "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
      "nodes": [{"mesh": 0, "scale": [1, 1, 1], "children": [3]}, {"camera": 0, "translation": [0, 0, 5]},
                {"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"rotation": [0, 0, 0, 1]}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 3, "material": 0, "mode": 4}]}],
      "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.5}}],
      "extensionsUsed": ["KHR_lights_punctual"],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 1, 1], "intensity": 2, "range": 50,
                     "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}]}},
      "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                      "samplers": [{"input": 1, "output": 2, "interpolation": "LINEAR"}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
                    {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"},
                    {"bufferView": 3, "componentType": 5123, "count": 3, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                      {"buffer": 0, "byteOffset": 44, "byteLength": 24},
                      {"buffer": 0, "byteOffset": 68, "byteLength": 8}])",
                                    data));
  return doc;
}

/// What loading gives: the notes, or one refusal; and a text of all that is drawn.
struct Outcome {
  std::vector<std::string> notes;
  std::string drawn;

  [[nodiscard]] bool says(const std::string& part) const {
    for (const std::string& note : notes)
      if (note.find(part) != std::string::npos) return true;
    return false;
  }
};

std::string text_of(const Scene& scene) {
  std::string out = std::to_string(scene.frame_count());
  const auto add = [&out](double v) { out += " " + std::to_string(v); };
  const auto add3 = [&](const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  };
  for (int i = 0; i < 2; ++i) {
    const SceneFrame f = scene.frame(i, 2);
    const Camera& c = f.camera;
    for (const glm::dvec3& v : {c.eye, c.right, c.up, c.forward}) add3(v);
    for (const double v : {c.half_height, c.near, c.far, c.aspect, c.perspective ? 1.0 : 0.0}) add(v);
    for (const Light& l : f.lights) {
      for (const glm::dvec3& v : {l.direction, l.position, l.color}) add3(v);
      for (const double v : {l.range, l.inner_cosine, l.outer_cosine, l.directional ? 1.0 : 0, l.spot ? 1.0 : 0})
        add(v);
    }
    for (const Triangle& t : f.triangles) {
      for (const std::uint32_t v : t.vertex) add3(f.vertices[v]);
      for (const std::uint32_t s : t.shading) {
        add3(f.shading[s].normal);
        add3(f.shading[s].color);
      }
      for (const int v : {static_cast<int>(t.alpha), t.unlit ? 1 : 0, static_cast<int>(t.sides)}) add(v);
    }
  }
  return out;
}

Outcome outcome(const Json& doc) {
  const TempDirectory dir;
  const std::string file = dir.write("x.gltf", doc.dump());
  try {
    const Scene scene = Scene::load(file);
    return {scene.notes(), text_of(scene)};
  } catch (const Error& e) {
    return {{}, std::string("refused: ") + e.what()};
  }
}

enum class Fate { drawn, told, silent };

using Changes = std::vector<std::pair<const char*, const char*>>;  // where, by a JSON pointer, and what

struct Row {
  const char* property;
  Changes changes;
  Fate fate;
  const char* note = "";
};

Json changed(const Changes& changes) {
  Json doc = base();
  for (const auto& [where, what] : changes) doc[Json::json_pointer(where)] = Json::parse(what);
  return doc;
}

const Changes kTexture{
    {"/textures", "[{\"source\": 0, \"sampler\": 0}]"},
    {"/images", "[{\"uri\": \"none.png\", \"mimeType\": \"image/png\", \"name\": \"i\"}]"},
    {"/samplers", "[{\"magFilter\": 9728, \"minFilter\": 9728, \"wrapS\": 10497, \"wrapT\": 10497}]"}};

Changes with_texture(const char* where) {
  Changes changes = kTexture;
  changes.emplace_back(where, "{\"index\": 0, \"texCoord\": 0, \"scale\": 1, \"strength\": 1}");
  return changes;
}

/// Every property of glTF 2.0, section 5 of the specification; those of objects that nothing but textures refer to, as
/// sampler.wrapS, go with the row of the texture.
const std::vector<Row> kProperties{
    {"accessor.bufferView", {{"/accessors/0/bufferView", "2"}, {"/accessors/0/count", "2"}}, Fate::drawn},
    {"accessor.byteOffset", {{"/accessors/0/byteOffset", "12"}, {"/bufferViews/0/byteLength", "48"}}, Fate::drawn},
    {"accessor.componentType", {{"/accessors/3/componentType", "5121"}}, Fate::drawn},
    {"accessor.normalized",
     {{"/accessors/0/normalized", "true"}, {"/accessors/0/componentType", "5120"}, {"/bufferViews/0/byteStride", "4"}},
     Fate::drawn},
    {"accessor.count", {{"/accessors/3/count", "2"}}, Fate::drawn},
    {"accessor.type", {{"/accessors/0/type", "\"VEC2\""}}, Fate::drawn},
    {"accessor.max", {{"/accessors/0/max", "[1, 1, 0]"}}, Fate::silent},
    {"accessor.min", {{"/accessors/0/min", "[0, 0, 0]"}}, Fate::silent},
    {"accessor.sparse",
     {{"/accessors/0/sparse",
       "{\"count\": 1, \"indices\": {\"bufferView\": 3, \"byteOffset\": 2, \"componentType\": 5123}, "
       "\"values\": {\"bufferView\": 2, \"byteOffset\": 12}}"}},
     Fate::drawn},
    {"accessor.name", {{"/accessors/0/name", "\"n\""}}, Fate::silent},
    {"animation.channels", {{"/animations/0/channels", "[]"}}, Fate::drawn},
    {"animation.samplers", {{"/animations/0/samplers", "[]"}}, Fate::drawn},
    {"animation.name", {{"/animations/0/name", "\"n\""}}, Fate::silent},
    {"animations, a second one",
     {{"/animations/1", "{\"channels\": [], \"samplers\": []}"}},
     Fate::told,
     "1 animation is ignored"},
    {"channel.sampler", {{"/animations/0/channels/0/sampler", "1"}}, Fate::drawn},
    {"channel.target.node", {{"/animations/0/channels/0/target/node", "1"}}, Fate::drawn},
    {"channel.target.node, none",
     {{"/animations/0/channels/0/target", "{\"path\": \"translation\"}"}},
     Fate::told,
     "animation channel"},
    {"channel.target.path", {{"/animations/0/channels/0/target/path", "\"scale\""}}, Fate::drawn},
    {"channel.target.path, weights",
     {{"/animations/0/channels/0/target/path", "\"weights\""}},
     Fate::told,
     "morph animation"},
    {"channel.target.path, unknown",
     {{"/animations/0/channels/0/target/path", "\"colour\""}},
     Fate::told,
     "1 animation channel is of no known kind"},
    {"animation.sampler.input", {{"/animations/0/samplers/0/input", "2"}}, Fate::drawn},
    {"animation.sampler.interpolation", {{"/animations/0/samplers/0/interpolation", "\"STEP\""}}, Fate::drawn},
    {"animation.sampler.interpolation, unknown", {{"/animations/0/samplers/0/interpolation", "\"JUMP\""}}, Fate::drawn},
    {"animation.sampler.output", {{"/animations/0/samplers/0/output", "0"}, {"/accessors/0/count", "2"}}, Fate::drawn},
    {"asset.copyright", {{"/asset/copyright", "\"c\""}}, Fate::silent},
    {"asset.generator", {{"/asset/generator", "\"g\""}}, Fate::silent},
    {"asset.version", {{"/asset/version", "\"3.0\""}}, Fate::drawn},
    {"asset.minVersion", {{"/asset/minVersion", "\"2.1\""}}, Fate::drawn},
    {"asset.extras", {{"/asset/extras", "{\"author\": \"a\"}"}}, Fate::silent},
    {"asset.extras.kage.frames", {{"/asset/extras", "{\"kage\": {\"frames\": 3}}"}}, Fate::drawn},
    {"buffer.uri", {{"/buffers/0/uri", "\"none.bin\""}}, Fate::drawn},
    {"buffer.byteLength", {{"/buffers/0/byteLength", "40"}}, Fate::drawn},
    {"buffer.name", {{"/buffers/0/name", "\"n\""}}, Fate::silent},
    {"bufferView.buffer", {{"/bufferViews/0/buffer", "1"}}, Fate::drawn},
    {"bufferView.byteOffset", {{"/bufferViews/0/byteOffset", "12"}}, Fate::drawn},
    {"bufferView.byteLength", {{"/bufferViews/0/byteLength", "24"}}, Fate::drawn},
    {"bufferView.byteStride", {{"/bufferViews/0/byteStride", "16"}, {"/bufferViews/0/byteLength", "60"}}, Fate::drawn},
    {"bufferView.target", {{"/bufferViews/0/target", "34962"}}, Fate::silent},
    {"bufferView.name", {{"/bufferViews/0/name", "\"n\""}}, Fate::silent},
    {"camera.type, camera.orthographic, orthographic.xmag, ymag, zfar, znear",
     {{"/cameras/0",
       "{\"type\": \"orthographic\", \"orthographic\": {\"xmag\": 2, \"ymag\": 1, \"zfar\": 9, \"znear\": 1}}"}},
     Fate::drawn},
    {"camera.orthographic beside a perspective",
     {{"/cameras/0/orthographic", "{\"xmag\": 1}"}},
     Fate::told,
     "cameras/orthographic"},
    {"camera.perspective", {{"/cameras/0/perspective", "{}"}}, Fate::drawn},
    {"camera.name", {{"/cameras/0/name", "\"n\""}}, Fate::silent},
    {"cameras, a second one", {{"/cameras/1", "{}"}, {"/nodes/2/camera", "1"}}, Fate::told, "1 camera is ignored"},
    {"perspective.aspectRatio", {{"/cameras/0/perspective/aspectRatio", "2"}}, Fate::drawn},
    {"perspective.yfov", {{"/cameras/0/perspective/yfov", "2"}}, Fate::drawn},
    {"perspective.zfar", {{"/cameras/0/perspective/zfar", "100"}}, Fate::drawn},
    {"perspective.znear", {{"/cameras/0/perspective/znear", "0.25"}}, Fate::drawn},
    {"glTF.extensionsUsed", {{"/extensionsUsed/1", "\"KHR_materials_unlit\""}}, Fate::silent},
    {"glTF.extensionsRequired", {{"/extensionsRequired", "[\"FOO_bar\"]"}}, Fate::drawn},
    {"glTF.images", {{"/images", "[{\"uri\": \"none.png\"}]"}}, Fate::silent},
    {"glTF.samplers", {{"/samplers", "[{}]"}}, Fate::silent},
    {"glTF.textures", kTexture, Fate::told, "1 texture is ignored"},
    {"glTF.skins", {{"/skins", "[{\"joints\": [0]}]"}}, Fate::silent},
    {"glTF.scene", {{"/scene", "1"}, {"/scenes/1", "{\"nodes\": [0]}"}}, Fate::drawn},
    {"glTF.scenes, a second one", {{"/scenes/1", "{\"nodes\": [1]}"}}, Fate::told, "1 scene is ignored"},
    {"scene.nodes", {{"/scenes/0/nodes", "[0]"}}, Fate::drawn},
    {"scene.name", {{"/scenes/0/name", "\"n\""}}, Fate::silent},
    {"material.pbrMetallicRoughness.baseColorFactor",
     {{"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 0, 0, 1]"}},
     Fate::drawn},
    {"material.pbrMetallicRoughness.baseColorTexture",
     with_texture("/materials/0/pbrMetallicRoughness/baseColorTexture"), Fate::told, "1 texture is ignored"},
    {"material.pbrMetallicRoughness.metallicFactor",
     {{"/materials/0/pbrMetallicRoughness/metallicFactor", "0.5"}},
     Fate::told,
     "1 material is metallic or glossy"},
    {"material.pbrMetallicRoughness.metallicFactor, its default of 1",
     {{"/materials/0/pbrMetallicRoughness", "{\"baseColorFactor\": [0.5, 0.5, 0.5, 1]}"}},
     Fate::told,
     "1 material is metallic or glossy"},
    {"material.pbrMetallicRoughness.metallicFactor 0",
     {{"/materials/0/pbrMetallicRoughness/metallicFactor", "0"}},
     Fate::silent},
    {"material.pbrMetallicRoughness.roughnessFactor",
     {{"/materials/0/pbrMetallicRoughness/roughnessFactor", "0.5"}},
     Fate::told,
     "1 material is metallic or glossy"},
    {"material.pbrMetallicRoughness.roughnessFactor 1",
     {{"/materials/0/pbrMetallicRoughness/roughnessFactor", "1"}},
     Fate::silent},
    {"material.pbrMetallicRoughness.metallicRoughnessTexture",
     with_texture("/materials/0/pbrMetallicRoughness/metallicRoughnessTexture"), Fate::told, "1 texture is ignored"},
    {"material.normalTexture", with_texture("/materials/0/normalTexture"), Fate::told, "1 texture is ignored"},
    {"material.occlusionTexture", with_texture("/materials/0/occlusionTexture"), Fate::told, "1 texture is ignored"},
    {"material.emissiveTexture", with_texture("/materials/0/emissiveTexture"), Fate::told, "1 texture is ignored"},
    {"material.emissiveFactor",
     {{"/materials/0/emissiveFactor", "[0, 1, 0]"}},
     Fate::told,
     "1 material emits light, which is ignored"},
    {"material.emissiveFactor 0", {{"/materials/0/emissiveFactor", "[0, 0, 0]"}}, Fate::silent},
    {"material.emissiveFactor over black",
     {{"/materials/0/emissiveFactor", "[0, 1, 0]"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[0, 0, 0, 1]"}},
     Fate::drawn},
    {"material.alphaMode, BLEND",
     {{"/materials/0/alphaMode", "\"BLEND\""}, {"/materials/0/pbrMetallicRoughness/baseColorFactor/3", "0.5"}},
     Fate::drawn},
    {"material.alphaMode, MASK; alphaCutoff",
     {{"/materials/0/alphaMode", "\"MASK\""}, {"/materials/0/alphaCutoff", "0.3"}},
     Fate::told,
     "1 material has an alpha mask"},
    {"material.alphaMode, unknown",
     {{"/materials/0/alphaMode", "\"ADD\""}},
     Fate::told,
     "material 0: alphaMode 'ADD' is unknown"},
    {"material.alphaCutoff", {{"/materials/0/alphaCutoff", "0.3"}}, Fate::silent},
    {"material.doubleSided", {{"/materials/0/doubleSided", "true"}}, Fate::drawn},
    {"material.name", {{"/materials/0/name", "\"n\""}}, Fate::silent},
    {"mesh.primitives", {{"/meshes/0/primitives", "[]"}}, Fate::drawn},
    {"mesh.weights", {{"/meshes/0/weights", "[1]"}}, Fate::silent},
    {"mesh.name", {{"/meshes/0/name", "\"n\""}}, Fate::silent},
    {"primitive.attributes, NORMAL", {{"/meshes/0/primitives/0/attributes/NORMAL", "0"}}, Fate::drawn},
    {"primitive.attributes, COLOR_0", {{"/meshes/0/primitives/0/attributes/COLOR_0", "0"}}, Fate::drawn},
    {"primitive.attributes, COLOR_1",
     {{"/meshes/0/primitives/0/attributes/COLOR_1", "0"}},
     Fate::told,
     "meshes/primitives/attributes/COLOR_1"},
    {"primitive.attributes, TEXCOORD_0, TANGENT, JOINTS_0, WEIGHTS_0, _OWN",
     {{"/meshes/0/primitives/0/attributes/TEXCOORD_0", "0"},
      {"/meshes/0/primitives/0/attributes/TANGENT", "0"},
      {"/meshes/0/primitives/0/attributes/JOINTS_0", "0"},
      {"/meshes/0/primitives/0/attributes/WEIGHTS_0", "0"},
      {"/meshes/0/primitives/0/attributes/_OWN", "0"}},
     Fate::silent},
    {"primitive.indices", {{"/meshes/0/primitives/0/indices", "0"}}, Fate::drawn},
    {"primitive.material", {{"/meshes/0/primitives/0/material", "1"}, {"/materials/1", "{}"}}, Fate::drawn},
    {"primitive.mode", {{"/meshes/0/primitives/0/mode", "7"}}, Fate::drawn},
    {"primitive.mode, lines",
     {{"/meshes/0/primitives/1", "{\"attributes\": {\"POSITION\": 0}, \"mode\": 1}"}},
     Fate::told,
     "1 primitive of points or lines"},
    {"primitive.targets",
     {{"/meshes/0/primitives/0/targets", "[{\"POSITION\": 0}]"}},
     Fate::told,
     "1 primitive has morph targets"},
    {"node.camera", {{"/nodes/1/camera", "3"}}, Fate::drawn},
    {"node.children", {{"/nodes/0/children", "[9]"}}, Fate::drawn},
    {"node.skin", {{"/nodes/0/skin", "0"}, {"/skins", "[{\"joints\": [0]}]"}}, Fate::told, "1 skin is ignored"},
    {"node.matrix",
     {{"/nodes/1/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]"},
      {"/nodes/1", "{\"camera\": 0, \"matrix\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]}"}},
     Fate::drawn},
    {"node.matrix beside a translation",
     {{"/nodes/1/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1]"}},
     Fate::told,
     "nodes/translation"},
    {"node.mesh", {{"/nodes/0/mesh", "1"}}, Fate::drawn},
    {"node.rotation", {{"/nodes/0/rotation", "[0, 0, 1, 0]"}}, Fate::drawn},
    {"node.scale", {{"/nodes/0/scale", "[2, 2, 2]"}}, Fate::drawn},
    {"node.translation", {{"/nodes/1/translation", "[1, 0, 5]"}}, Fate::drawn},
    {"node.weights", {{"/nodes/0/weights", "[1]"}}, Fate::silent},
    {"node.name", {{"/nodes/0/name", "\"n\""}}, Fate::silent},
    // Extensions that are drawn, and what may be drawn of others.
    {"KHR_lights_punctual color", {{"/extensions/KHR_lights_punctual/lights/0/color", "[1, 0, 0]"}}, Fate::drawn},
    {"KHR_lights_punctual range", {{"/extensions/KHR_lights_punctual/lights/0/range", "60"}}, Fate::drawn},
    {"KHR_lights_punctual spot",
     {{"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", "0.4"}},
     Fate::drawn},
    {"KHR_lights_punctual spot of a point light",
     {{"/extensions/KHR_lights_punctual/lights/0/type", "\"point\""}},
     Fate::told,
     "extensions/KHR_lights_punctual/lights/spot"},
    {"KHR_lights_punctual type", {{"/extensions/KHR_lights_punctual/lights/0/type", "\"area\""}}, Fate::drawn},
    {"KHR_materials_unlit", {{"/materials/0/extensions", "{\"KHR_materials_unlit\": {}}"}}, Fate::drawn},
    {"KHR_materials_transmission",
     {{"/materials/0/extensions", "{\"KHR_materials_transmission\": {\"transmissionFactor\": 0.5}}"}},
     Fate::drawn},
    {"KHR_materials_transmission of all",
     {{"/materials/0/extensions", "{\"KHR_materials_transmission\": {\"transmissionFactor\": 1}}"}},
     Fate::told,
     "1 material lets all light through"},
    {"KHR_materials_emissive_strength",
     {{"/materials/0/emissiveFactor", "[0, 0.25, 0]"},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[0, 0, 0, 1]"},
      {"/materials/0/extensions", "{\"KHR_materials_emissive_strength\": {\"emissiveStrength\": 2}}"}},
     Fate::drawn},
    {"KHR_materials_pbrSpecularGlossiness diffuseFactor",
     {{"/materials/0",
       "{\"extensions\": {\"KHR_materials_pbrSpecularGlossiness\": {\"diffuseFactor\": [1, 0, 0, 1]}}}"}},
     Fate::drawn},
    {"KHR_materials_pbrSpecularGlossiness glossinessFactor",
     {{"/materials/0/extensions", "{\"KHR_materials_pbrSpecularGlossiness\": {\"glossinessFactor\": 1}}"}},
     Fate::told,
     "1 material is metallic or glossy"},
    {"KHR_node_visibility", {{"/nodes/2/extensions/KHR_node_visibility", "{\"visible\": false}"}}, Fate::drawn},
    {"KHR_node_visibility, true", {{"/nodes/2/extensions/KHR_node_visibility", "{\"visible\": true}"}}, Fate::silent},
    {"KHR_animation_pointer to a visibility",
     {{"/animations/0/channels/1",
       "{\"sampler\": 0, \"target\": {\"path\": \"pointer\", \"extensions\": {\"KHR_animation_pointer\": "
       "{\"pointer\": \"/nodes/0/extensions/KHR_node_visibility/visible\"}}}}"}},
     Fate::told,
     "1 node's visibility is animated, which is ignored"},
    {"KHR_animation_pointer to a colour",
     {{"/animations/0/channels/1",
       "{\"sampler\": 0, \"target\": {\"path\": \"pointer\", \"extensions\": {\"KHR_animation_pointer\": "
       "{\"pointer\": \"/materials/0/emissiveFactor\"}}}}"}},
     Fate::told,
     "1 animated property is ignored (KHR_animation_pointer)"},
    {"EXT_mesh_gpu_instancing",
     {{"/nodes/0/extensions", "{\"EXT_mesh_gpu_instancing\": {}}"}},
     Fate::told,
     "1 node's GPU instances are ignored"},
};

/// The Khronos list: github.com/KhronosGroup/glTF/tree/main/extensions, archived ones too, and drafts.
const std::vector<std::string> kExtensions{"ADOBE_materials_clearcoat_specular",
                                           "ADOBE_materials_clearcoat_tint",
                                           "ADOBE_materials_thin_transparency",
                                           "AGI_articulations",
                                           "AGI_stk_metadata",
                                           "CESIUM_primitive_outline",
                                           "EXT_feature_metadata",
                                           "EXT_implicit_cylinder_region",
                                           "EXT_implicit_ellipsoid_region",
                                           "EXT_instance_features",
                                           "EXT_lights_ies",
                                           "EXT_lights_image_based",
                                           "EXT_mesh_features",
                                           "EXT_mesh_gpu_instancing",
                                           "EXT_mesh_manifold",
                                           "EXT_mesh_primitive_restart",
                                           "EXT_meshopt_compression",
                                           "EXT_primitive_voxels",
                                           "EXT_structural_metadata",
                                           "EXT_texture_avif",
                                           "EXT_texture_webp",
                                           "FB_geometry_metadata",
                                           "GODOT_single_root",
                                           "GRIFFEL_bim_data",
                                           "KHR_accessor_float64",
                                           "KHR_animation_pointer",
                                           "KHR_audio_emitter",
                                           "KHR_collision_shapes",
                                           "KHR_draco_mesh_compression",
                                           "KHR_gaussian_splatting",
                                           "KHR_implicit_shapes",
                                           "KHR_interactivity",
                                           "KHR_lights_punctual",
                                           "KHR_materials_anisotropy",
                                           "KHR_materials_clearcoat",
                                           "KHR_materials_diffuse_transmission",
                                           "KHR_materials_dispersion",
                                           "KHR_materials_emissive_strength",
                                           "KHR_materials_ior",
                                           "KHR_materials_iridescence",
                                           "KHR_materials_pbrSpecularGlossiness",
                                           "KHR_materials_sheen",
                                           "KHR_materials_specular",
                                           "KHR_materials_subsurface",
                                           "KHR_materials_transmission",
                                           "KHR_materials_unlit",
                                           "KHR_materials_variants",
                                           "KHR_materials_volume",
                                           "KHR_materials_volume_scatter",
                                           "KHR_mesh_quantization",
                                           "KHR_meshopt_compression",
                                           "KHR_node_hoverability",
                                           "KHR_node_selectability",
                                           "KHR_node_visibility",
                                           "KHR_physics_rigid_bodies",
                                           "KHR_techniques_webgl",
                                           "KHR_texture_basisu",
                                           "KHR_texture_transform",
                                           "KHR_xmp",
                                           "KHR_xmp_json_ld",
                                           "MPEG_accessor_timed",
                                           "MPEG_animation_timing",
                                           "MPEG_audio_spatial",
                                           "MPEG_buffer_circular",
                                           "MPEG_media",
                                           "MPEG_mesh_linking",
                                           "MPEG_scene_dynamic",
                                           "MPEG_texture_video",
                                           "MPEG_viewport_recommended",
                                           "MSFT_lod",
                                           "MSFT_packing_normalRoughnessMetallic",
                                           "MSFT_packing_occlusionRoughnessMetallic",
                                           "MSFT_texture_dds",
                                           "NV_materials_mdl",
                                           "VRMC_materials_mtoon",
                                           "VRMC_node_constraint",
                                           "VRMC_springBone",
                                           "VRMC_vrm"};

const std::set<std::string> kDrawn{"KHR_lights_punctual",
                                   "KHR_materials_emissive_strength",
                                   "KHR_materials_pbrSpecularGlossiness",
                                   "KHR_materials_transmission",
                                   "KHR_materials_unlit",
                                   "KHR_mesh_quantization",
                                   "KHR_node_visibility"};
const std::set<std::string> kAbout{"KHR_xmp", "KHR_xmp_json_ld"};
const std::set<std::string> kOfTextures{"EXT_texture_avif", "EXT_texture_webp", "KHR_texture_basisu",
                                        "KHR_texture_transform", "MSFT_texture_dds"};

}  // namespace

TEST_CASE("each property of glTF 2.0 is drawn, told or silent on purpose") {
  const Outcome plain = outcome(base());
  CHECK(plain.notes.empty());
  REQUIRE(plain.drawn.rfind("refused", 0) != 0);
  for (const Row& row : kProperties) {
    const Outcome got = outcome(changed(row.changes));
    INFO(row.property << ": " << got.drawn.substr(0, 120));
    for (const std::string& note : got.notes) INFO(note);
    switch (row.fate) {
      case Fate::drawn:  // or refused
        CHECK(got.drawn != plain.drawn);
        break;
      case Fate::told:
        CHECK(got.says(row.note));
        CHECK(got.notes.size() == 1);
        break;
      case Fate::silent:
        CHECK(got.notes.empty());
        CHECK(got.drawn == plain.drawn);
        break;
    }
  }
}

TEST_CASE("each extension of the Khronos list is drawn, or named once; where it is required, drawn or refused") {
  for (const std::string& name : kExtensions) {
    INFO(name);
    const bool quiet = kDrawn.count(name) + kAbout.count(name) > 0;
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      Json doc = base();
      doc[list].push_back(name);
      const Outcome got = outcome(doc);
      const bool required = list == std::string("extensionsRequired");
      const bool refused = got.drawn.rfind("refused", 0) == 0;
      CHECK(refused == (required && !quiet && kOfTextures.count(name) == 0));
      if (refused) CHECK(got.drawn.find(name) != std::string::npos);
      if (!refused) CHECK(got.says(name) == !quiet);
      CHECK(got.notes.size() == (refused || quiet ? 0 : 1));
    }
    // Not in any list, which the format demands, but at some place.
    for (const char* place : {"/materials/0", "/nodes/0", "/meshes/0/primitives/0", "/accessors/0", ""}) {
      if (quiet) continue;
      Json doc = base();
      doc[Json::json_pointer(std::string(place) + "/extensions/" + name)] = Json::object();
      const Outcome got = outcome(doc);
      INFO(place);
      CHECK(got.says(name) != got.says("GPU instances"));
      CHECK(got.notes.size() == 1);
    }
  }
}

TEST_CASE("an extension that is drawn is named where it stands at a wrong place") {
  for (const std::string& name : kDrawn) {
    Json doc = base();
    doc["cameras"][0]["extensions"][name] = Json::object();
    const Outcome got = outcome(doc);
    CHECK(got.says("cameras/extensions/" + name));
  }
}

TEST_CASE("a key that nobody knows is named, wherever it stands") {
  const Json doc = base();
  std::vector<std::pair<Json::json_pointer, const Json*>> waiting{{Json::json_pointer(), &doc}};
  int places = 0;
  while (!waiting.empty()) {
    const auto [place, value] = waiting.back();
    waiting.pop_back();
    if (!value->is_structured()) continue;
    for (const auto& [key, member] : value->items())
      if (value->is_object())
        waiting.emplace_back(place / key, &member);
      else
        waiting.emplace_back(place / static_cast<std::size_t>(std::stoul(key)), &member);
    // Attributes have keys of their own, but for these an unknown one is like others.
    if (!value->is_object() || place.to_string() == "/asset" || (!place.empty() && place.back() == "extensions"))
      continue;
    Json other = doc;
    other[place]["neverHeardOf"] = 1;
    const Outcome got = outcome(other);
    INFO(place.to_string());
    CHECK(got.says("neverHeardOf"));
    CHECK(got.notes.size() == 1);
    ++places;
  }
  CHECK(places > 25);
}

TEST_CASE("long lists end, and names with line breaks stay on their line") {
  Json doc = base();
  for (int i = 0; i < 20; ++i) doc["extensionsUsed"].push_back("FOO_" + std::to_string(100 + i));
  doc["materials"][0]["a\nb"] = 1;
  const Outcome got = outcome(doc);
  CHECK(got.says(
      "20 extensions are ignored: FOO_100, FOO_101, FOO_102, FOO_103, FOO_104, FOO_105, FOO_106, FOO_107 and 12 more"));
  CHECK(got.says("1 key is ignored, which kage does not know: materials/a b"));
  std::string deep(100000, '[');
  deep += std::string(100000, ']');
  Json nested = base();
  nested["extras"] = 0;
  std::string text = nested.dump();
  text.replace(text.find("\"extras\":0"), 10, "\"deep\":" + deep);
  const TempDirectory dir;
  const Scene scene = Scene::load(dir.write("deep.gltf", text));
  CHECK(test::has_note(scene, "deep"));
}

TEST_CASE("unlit, emission over black, transmission, sides") {
  const auto triangle = [](const Changes& changes) {
    const TempDirectory dir;
    const Scene scene = Scene::load(dir.write("x.gltf", changed(changes).dump()));
    const SceneFrame f = scene.frame(0, 1);
    return std::pair(f.triangles[0], f.shading[f.triangles[0].shading[0]].color);
  };
  const auto [plain, grey] = triangle({});
  CHECK_FALSE(plain.unlit);
  CHECK(plain.sides == Sides::front);
  const auto [unlit, same] = triangle({{"/materials/0/extensions", "{\"KHR_materials_unlit\": {}}"}});
  CHECK(unlit.unlit);
  CHECK(same == grey);
  const char* const black = "[0, 0, 0, 1]";
  const auto [lamp, glow] =
      triangle({{"/materials/0/pbrMetallicRoughness/baseColorFactor", black},
                {"/materials/0/emissiveFactor", "[0.25, 0.125, 1]"},
                {"/meshes/0/primitives/0/attributes/COLOR_0", "0"},
                {"/materials/0/extensions", "{\"KHR_materials_emissive_strength\": {\"emissiveStrength\": 2}}"}});
  CHECK(lamp.unlit);
  CHECK(glow == glm::dvec3{0.5, 0.25, 1});
  const auto through = [&](const char* factor, const char* mode) {
    const std::string extension =
        std::string("{\"KHR_materials_transmission\": {\"transmissionFactor\": ") + factor + "}}";
    return static_cast<int>(triangle({{"/materials/0/extensions", extension.c_str()},
                                      {"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 1, 1, 0.5]"},
                                      {"/materials/0/alphaMode", mode}})
                                .first.alpha);
  };
  CHECK(through("0.8", "\"OPAQUE\"") == 51);
  CHECK(through("0", "\"OPAQUE\"") == 255);
  CHECK(through("0.6", "\"BLEND\"") == 51);
  CHECK(through("7", "\"OPAQUE\"") == 0);
  CHECK(triangle({{"/materials/0/doubleSided", "true"}}).first.sides == Sides::both);
}

TEST_CASE("hidden nodes are neither drawn nor shine, their children likewise; a camera sees all the same") {
  Json doc = base();
  doc["nodes"][3] = Json::parse(R"({"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": true}}})");
  const auto hide = [](Json& node) { node["extensions"]["KHR_node_visibility"]["visible"] = false; };
  const TempDirectory dir;
  const auto load = [&](const Json& d) { return Scene::load(dir.write("x.gltf", d.dump())); };
  CHECK(load(doc).objects().size() == 2);
  hide(doc["nodes"][1]);
  CHECK(load(doc).frame(0, 1).camera.eye == glm::dvec3{0, 0, 5});
  hide(doc["nodes"][2]);
  CHECK(test::has_note(load(doc), "no light"));
  Json child = doc;
  hide(child["nodes"][3]);
  CHECK(load(child).objects().size() == 1);
  hide(doc["nodes"][0]);  // the child says that it is visible, which does not count
  const std::string file = dir.write("x.gltf", doc.dump());
  CHECK(test::refusal(file) == file + ": nodes: all that have a mesh are hidden (KHR_node_visibility)");
}
