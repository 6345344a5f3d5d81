// SPDX-License-Identifier: Apache-2.0
// Keys that nobody knows are named wherever they stand; contents that the format does not allow are named or refused.
// For a key that changes how a triangle looks or whether a node is there, the note says how much is drawn.
#include "gltf_outcome.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::Changes;
using test::Json;
using test::Outcome;
using test::TempDirectory;

TEST_CASE("a key that nobody knows is named, wherever it stands") {
  const Json doc = test::base();
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
    const Outcome got = test::outcome(other);
    INFO(place.to_string());
    CHECK(got.says("neverHeardOf"));
    CHECK(got.notes.size() == 1);
    ++places;
  }
  CHECK(places > 25);
}

TEST_CASE("long lists end, and names with line breaks stay on their line") {
  Json doc = test::base();
  for (int i = 0; i < 20; ++i) doc["extensionsUsed"].push_back("FOO_" + std::to_string(100 + i));
  doc["materials"][0]["a\nb"] = 1;
  const Outcome got = test::outcome(doc);
  CHECK(got.says(
      "20 extensions are ignored: FOO_100, FOO_101, FOO_102, FOO_103, FOO_104, FOO_105, FOO_106, FOO_107 and 12 more"));
  CHECK(got.says("1 key is ignored, which kage does not know: materials/a b"));
}

TEST_CASE("what nests deep is told, and refused where it is deeper than any JSON that is read") {
  const TempDirectory dir;
  const auto nested = [&](std::size_t levels) {
    Json doc = test::base();
    doc["extras"] = 0;
    std::string text = doc.dump();
    text.replace(text.find("\"extras\":0"), 10, "\"deep\":" + std::string(levels, '[') + std::string(levels, ']'));
    return Scene::load(dir.write("deep.gltf", text));
  };
  CHECK(test::has_note(nested(100), "deep"));
  for (const std::size_t levels : {200U, 100000U}) CHECK_THROWS_AS(nested(levels), Error);
}

TEST_CASE("unlit, emission over black, transmission, sides") {
  const auto triangle = [](const Changes& changes) {
    const TempDirectory dir;
    const Scene scene = Scene::load(dir.write("x.gltf", test::changed(changes).dump()));
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
  Json doc = test::base();
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

namespace {

struct Defect {
  const char* said;  // the end of the refusal, or a note
  Changes changes;
  bool drawn = false;
};

/// An accessor 4 of the given members, as the first primitive's attribute.
Changes attribute(const char* key, const char* accessor, const Changes& more = {}) {
  Changes changes{{"/accessors/4", accessor}, {key, "4"}};
  changes.insert(changes.end(), more.begin(), more.end());
  return changes;
}

const char* const kColor = "/meshes/0/primitives/0/attributes/COLOR_0";
const char* const kNormal = "/meshes/0/primitives/0/attributes/NORMAL";
const char* const kPosition = "/meshes/0/primitives/0/attributes/POSITION";

void check_defects(const std::vector<Defect>& defects) {
  for (const Defect& d : defects) {
    const Outcome got = test::outcome(test::changed(d.changes));
    INFO(d.said << ": " << got.drawn.substr(0, 200));
    for (const std::string& note : got.notes) INFO(note);
    CHECK((got.drawn.rfind("refused", 0) != 0) == d.drawn);
    if (d.drawn) {
      CHECK(got.says(d.said));
      CHECK(got.notes.size() == 1);
    } else {
      CHECK(got.drawn.find(d.said) != std::string::npos);
    }
  }
}

}  // namespace

TEST_CASE("strides: a multiple of 4 that is as long as an element, of vertices alone") {
  const char* const kStride = "/bufferViews/0/byteStride";
  check_defects({
      {"bufferView 0: byteStride 8 is less than the 12 bytes of an element of accessor 0", {{kStride, "8"}}},
      {"bufferView 0: byteStride 2 is not a multiple of 4 from 4 to 252", {{kStride, "2"}}},
      {"bufferView 0: byteStride 253 is not a multiple of 4 from 4 to 252", {{kStride, "253"}}},
      {"bufferView 0: byteStride 256 is not a multiple of 4 from 4 to 252", {{kStride, "256"}}},
      {"bufferView 0 has byteStride 0, which is taken as none", {{kStride, "0"}}, true},
      {"bufferView 3: byteStride 4: the elements of accessor 3 are no vertices, and have no gaps",
       {{"/bufferViews/3/byteStride", "4"}, {"/accessors/3/count", "2"}}},
      {"bufferView 1: byteStride 8: the elements of accessor 1 are no vertices, and have no gaps",
       {{"/bufferViews/1/byteStride", "8"}, {"/accessors/1/count", "1"}}},
      {"bufferView 3: byteStride 8: the elements of accessor 0 are no vertices, and have no gaps",
       {{"/bufferViews/3/byteStride", "8"},
        {"/accessors/0/sparse",
         "{\"count\": 1, \"indices\": {\"bufferView\": 3, \"componentType\": 5123}, \"values\": {\"bufferView\": 2}}"},
        {"/meshes/0/primitives/0", "{\"attributes\": {\"POSITION\": 0}}"}}},
  });
  // As long as an element it changes nothing.
  const Outcome same = test::outcome(test::changed({{"/bufferViews/1/byteStride", "4"}, {kStride, "12"}}));
  CHECK(same.notes.empty());
  CHECK(same.drawn == test::outcome(test::base()).drawn);
}

TEST_CASE("types of numbers that the format does not have for what they are") {
  // Each float's second half is a number.
  const char* const kShorts =
      R"({"bufferView": 0, "byteOffset": 2, "componentType": 5122, "count": 3, "type": "VEC3"})";
  const char* const kBytes = R"({"bufferView": 2, "componentType": 5121, "count": 3, "type": "VEC3"})";
  check_defects({
      {"accessor 4 (COLOR_0) has whole numbers without 'normalized', which are taken as normalized",
       attribute(kColor, kBytes), true},
      {"accessor 4 (COLOR_0) has whole numbers without 'normalized', which are taken as normalized",
       attribute(kColor, R"({"bufferView": 2, "componentType": 5123, "count": 3, "type": "VEC3"})"), true},
      {"mesh 0 primitive 0: accessor 4 has component type 5120 (byte), which COLOR_0 cannot have",
       attribute(kColor,
                 R"({"bufferView": 2, "componentType": 5120, "count": 3, "type": "VEC4", "normalized": true})")},
      {"mesh 0 primitive 0: accessor 4 has component type 5125 (unsigned int), which COLOR_0 cannot have",
       attribute(kColor, R"({"componentType": 5125, "count": 3, "type": "VEC3", "normalized": true})")},
      {"accessor 4 (COLOR_0) has 'normalized', which is ignored: its numbers are floats",
       attribute(kColor, R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "normalized": true})"),
       true},
      {"accessor 4 (POSITION) has whole numbers without KHR_mesh_quantization, which are taken as if the file named it",
       attribute(kPosition, kShorts, {{"/bufferViews/0/byteStride", "12"}}), true},
      {"accessor 4 has component type 5125 (unsigned int), which POSITION cannot have",
       attribute(kPosition, R"({"bufferView": 0, "componentType": 5125, "count": 3, "type": "VEC3"})")},
      {"accessor 4 (NORMAL) has whole numbers without 'normalized', which are taken as normalized",
       attribute(kNormal, R"({"bufferView": 2, "byteOffset": 12, "componentType": 5120, "count": 3, "type": "VEC3"})",
                 {{"/extensionsUsed/1", "\"KHR_mesh_quantization\""}}),
       true},
      {"accessor 4 has component type 5121 (unsigned byte), which NORMAL cannot have",
       attribute(kNormal, R"({"bufferView": 0, "componentType": 5121, "count": 3, "type": "VEC3"})")},
      {"accessor 3 (indices) has 'normalized', which is ignored: they are numbers of things",
       {{"/accessors/3/normalized", "true"}},
       true},
      {"animation 0 channel 0: accessor 2 has component type 5122 (short), which an animation's vectors cannot have",
       {{"/accessors/2/componentType", "5122"}}},
      {"animation 0 channel 0: accessor 1 has component type 5123 (unsigned short), which an animation's times cannot",
       {{"/accessors/1/componentType", "5123"}}},
      {"accessor 4 (an animation's rotations) has whole numbers without 'normalized'",
       {{"/accessors/4", R"({"bufferView": 2, "byteOffset": 14, "componentType": 5121, "count": 2, "type": "VEC4"})"},
        {"/animations/0/samplers/0/output", "4"},
        {"/animations/0/channels/0/target/path", "\"rotation\""}},
       true},
  });
  // Values that are taken as normalized are drawn as those that are.
  std::string other = kBytes;
  other.insert(1, "\"normalized\": true, ");
  const Outcome normalized = test::outcome(test::changed(attribute(kColor, other.c_str())));
  CHECK(normalized.notes.empty());
  CHECK(normalized.drawn == test::outcome(test::changed(attribute(kColor, kBytes))).drawn);
  // With the extension whole numbers are positions like others.
  const Changes quantized{{"/bufferViews/0/byteStride", "12"}, {"/extensionsUsed/1", "\"KHR_mesh_quantization\""}};
  CHECK(test::outcome(test::changed(attribute(kPosition, kShorts, quantized))).notes.empty());
}

TEST_CASE("cameras that are none are refused") {
  check_defects({
      {"camera 0: type 'fisheye' is neither perspective nor orthographic", {{"/cameras/0/type", "\"fisheye\""}}},
      {"camera 0: has no type", {{"/cameras/0", "{\"perspective\": {\"yfov\": 1, \"znear\": 0.5}}"}}},
      {"camera 0: 'aspectRatio' is not above 0", {{"/cameras/0/perspective/aspectRatio", "0"}}},
      {"camera 0: 'aspectRatio' is not above 0", {{"/cameras/0/perspective/aspectRatio", "-2"}}},
      {"camera 0: 'zfar' is not beyond 'znear'", {{"/cameras/0/perspective/zfar", "0"}}},
      {"camera 0: 'zfar' is not beyond 'znear'", {{"/cameras/0/perspective/zfar", "-1"}}},
      {"camera 0: 'zfar' is not beyond 'znear'", {{"/cameras/0/perspective/zfar", "0.5"}}},
  });
}

TEST_CASE("animations of what is not there, of one thing twice, of a node with a matrix") {
  const char* const kSame = R"({"sampler": 0, "target": {"node": 0, "path": "translation"}})";
  const char* const kOther = R"({"sampler": 0, "target": {"node": 0, "path": "scale"}})";
  check_defects({
      {"animation 0 channel 0: asks for number 77 of 4 nodes", {{"/animations/0/channels/0/target/node", "77"}}},
      {"animation 0 channel 1: moves node 0 (translation), as animation 0 channel 0 does",
       {{"/animations/0/channels/1", kSame}}},
      {"1 animated node has a matrix, which is ignored: the animation places it",
       {{"/nodes/0", "{\"mesh\": 0, \"matrix\": [2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1], \"children\": [3]}"},
        {"/animations/0/channels/1", kOther}},
       true},
  });
  CHECK(test::outcome(test::changed({{"/animations/0/channels/1", kOther}})).notes.empty());
}

TEST_CASE("colours and alpha outside of 0 to 1, textures that are not there") {
  const char* const kFactor = "/materials/0/pbrMetallicRoughness/baseColorFactor";
  check_defects({
      {"1 primitive has a colour above 1, which is taken as 1", {{kFactor, "[0, 0.5, 5, 1]"}}, true},
      {"1 primitive has a colour below 0, which is taken as 0", {{kFactor, "[-1, 0.5, 1, 1]"}}, true},
      {"1 primitive has a colour above 1, which is taken as 1",
       {{kFactor, "[4, 4, 4, 1]"}, {kColor, "0"}},  // 4 times 1 at a vertex
       true},
      {"1 material has an alpha or a transmissionFactor that is not 0 to 1",
       {{kFactor, "[0, 0.5, 1, 5]"}, {"/materials/0/alphaMode", "\"BLEND\""}},
       true},
      {"2 references to textures that are not in the file are ignored",
       {{"/materials/0/normalTexture", "{\"index\": 3}"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture", "{\"index\": 0}"}},
       true},
  });
  // A colour above 1 that a vertex takes below is none that is drawn.
  CHECK(test::outcome(test::changed({{kFactor, "[1.5, 1.5, 1.5, 1]"},
                                     {"/accessors/4", R"({"componentType": 5126, "count": 3, "type": "VEC3"})"},
                                     {kColor, "4"}}))
            .notes.empty());
}

TEST_CASE("a binary file's length: chunks that reach beyond it are refused, what lies behind it is told") {
  const auto word = [](std::size_t v) {
    return test::bytes_of(std::vector<std::uint32_t>{static_cast<std::uint32_t>(v)});
  };
  const TempDirectory dir;
  Json doc = test::base();
  std::string json = doc.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t whole = 20 + json.size();
  const auto file = [&](std::size_t says, const std::string& behind) {
    return dir.write("x.glb", "glTF" + word(2) + word(says) + word(json.size()) + "JSON" + json + behind);
  };
  const std::string short_one = file(whole - 4, "");
  CHECK(test::refusal(short_one) == short_one + ": header: says " + std::to_string(whole - 4) +
                                        " bytes, its chunks end at " + std::to_string(whole));
  CHECK(Scene::load(file(whole, "")).notes().empty());
  CHECK(test::has_note(Scene::load(file(whole, "abcd")), "4 bytes behind the length that the header says are ignored"));
}
