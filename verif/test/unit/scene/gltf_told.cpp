// SPDX-License-Identifier: Apache-2.0
// Keys that nobody knows are named wherever they stand; of what changes how a triangle looks and whether a node is
// there, how much is drawn.
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
  for (const std::size_t levels : {200, 100000}) CHECK_THROWS_AS(nested(levels), Error);
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
