// SPDX-License-Identifier: Apache-2.0
//
// A glTF file with something of everything that is drawn, changes of it, and what comes of loading them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "files.hpp"

namespace kage::test {

using Json = nlohmann::json;

/// A file that has something of everything that is drawn.
inline Json base() {
  const std::string data = bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}) +  // positions
                           bytes_of(std::vector<float>{0, 1, 0, 0, 0, 1, 2, 3}) +     // times, keys
                           bytes_of(std::vector<std::uint16_t>{0, 1, 2, 0});          // indices
  Json doc = Json::parse(gltf(R"(
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

/// The outcome of loading: the notes, or one refusal; and a text of all that is drawn.
struct Outcome {
  std::vector<std::string> notes;
  std::string drawn;

  [[nodiscard]] bool says(const std::string& part) const {
    for (const std::string& note : notes)
      if (note.find(part) != std::string::npos) return true;
    return false;
  }
};

inline std::string text_of(const Scene& scene) {
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

inline Outcome outcome(const Json& doc) {
  const TempDirectory dir;
  const std::string file = dir.write("x.gltf", doc.dump());
  try {
    const Scene scene = Scene::load(file);
    return {scene.notes(), text_of(scene)};
  } catch (const Error& e) {
    return {{}, std::string("refused: ") + e.what()};
  }
}

using Changes = std::vector<std::pair<const char*, const char*>>;  // where, by a JSON pointer, and what

inline Json changed(const Changes& changes) {
  Json doc = base();
  for (const auto& [where, what] : changes) doc[Json::json_pointer(where)] = Json::parse(what);
  return doc;
}

}  // namespace kage::test
