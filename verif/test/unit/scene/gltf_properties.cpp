// SPDX-License-Identifier: Apache-2.0
// Each property of glTF 2.0, one by one: kage draws it, or names it in a note, or it stands on the short list of
// properties that are silent on purpose.
#include "gltf_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::Changes;
using test::Outcome;

namespace {

enum class Fate { drawn, told, silent };

struct Row {
  const char* property;
  Changes changes;
  Fate fate;
  const char* note = "";
};

const Changes kTexture{
    {"/textures", "[{\"source\": 0, \"sampler\": 0}]"},
    {"/images", "[{\"uri\": \"none.png\", \"mimeType\": \"image/png\", \"name\": \"i\"}]"},
    {"/samplers", "[{\"magFilter\": 9728, \"minFilter\": 9728, \"wrapS\": 10497, \"wrapT\": 10497}]"}};

Changes with_texture(const char* where) {
  Changes changes = kTexture;
  changes.emplace_back(where, "{\"index\": 0, \"texCoord\": 0, \"scale\": 1, \"strength\": 1}");
  return changes;
}

/// Joints and weights of the mesh's vertices, out of bytes that are there.
Changes with_joints(const Changes& more) {
  Changes changes{{"/accessors/4", "{\"bufferView\": 0, \"componentType\": 5121, \"count\": 3, \"type\": \"VEC4\"}"},
                  {"/accessors/5",
                   "{\"bufferView\": 0, \"byteOffset\": 24, \"componentType\": 5121, \"normalized\": true, \"count\": "
                   "3, \"type\": \"VEC4\"}"},
                  {"/meshes/0/primitives/0/attributes/JOINTS_0", "4"},
                  {"/meshes/0/primitives/0/attributes/WEIGHTS_0", "5"}};
  changes.insert(changes.end(), more.begin(), more.end());
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
    {"primitive.attributes, JOINTS_0 and WEIGHTS_0", with_joints({}), Fate::silent},
    {"node.skin, skin.joints", with_joints({{"/nodes/0/skin", "0"}, {"/skins", "[{\"joints\": [1]}]"}}), Fate::drawn},
    {"skin.inverseBindMatrices, which these are not",
     with_joints({{"/nodes/0/skin", "0"}, {"/skins", "[{\"joints\": [0], \"inverseBindMatrices\": 0}]"}}), Fate::drawn},
    {"primitive.attributes, TEXCOORD_0, TANGENT, _OWN",
     {{"/meshes/0/primitives/0/attributes/TEXCOORD_0", "0"},
      {"/meshes/0/primitives/0/attributes/TANGENT", "0"},
      {"/meshes/0/primitives/0/attributes/_OWN", "0"}},
     Fate::silent},
    {"primitive.indices", {{"/meshes/0/primitives/0/indices", "0"}}, Fate::drawn},
    {"primitive.material", {{"/meshes/0/primitives/0/material", "1"}, {"/materials/1", "{}"}}, Fate::drawn},
    {"primitive.mode", {{"/meshes/0/primitives/0/mode", "7"}}, Fate::drawn},
    {"primitive.mode, lines",
     {{"/meshes/0/primitives/1", "{\"attributes\": {\"POSITION\": 0}, \"mode\": 1}"}},
     Fate::told,
     "1 primitive of points or lines"},
    {"primitive.targets", {{"/meshes/0/primitives/0/targets", "[{\"POSITION\": 0}]"}}, Fate::silent},
    {"primitive.targets and mesh.weights",
     {{"/meshes/0/primitives/0/targets", "[{\"POSITION\": 0}]"}, {"/meshes/0/weights", "[1]"}},
     Fate::drawn},
    {"primitive.targets and node.weights",
     {{"/meshes/0/primitives/0/targets", "[{\"POSITION\": 0}]"}, {"/nodes/0/weights", "[1]"}},
     Fate::drawn},
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

}  // namespace

TEST_CASE("each property of glTF 2.0 is drawn, told or silent on purpose") {
  const Outcome plain = test::outcome(test::base());
  CHECK(plain.notes.empty());
  REQUIRE(plain.drawn.rfind("refused", 0) != 0);
  for (const Row& row : kProperties) {
    const Outcome got = test::outcome(test::changed(row.changes));
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
