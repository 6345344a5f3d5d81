// SPDX-License-Identifier: Apache-2.0
// glTF's skins and morph targets: at rest, animated, in every form of the data; and what of them is refused or told.
#include <algorithm>

#include "gltf_outcome.hpp"
#include "scene/space.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::bytes_of;
using test::Json;

namespace {

/// A file that grows: accessors of its own bytes.
class File {
 public:
  Json doc = Json::parse(R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {}],
      "meshes": [{"primitives": [{"attributes": {}}]}], "accessors": [], "bufferViews": []})");

  template <typename T>
  int add(const char* type, std::size_t components, int component, const std::vector<T>& values,
          bool normalized = false) {
    const std::string more = bytes_of(values);
    doc["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", data_.size()}, {"byteLength", more.size()}});
    data_ += more + std::string((4 - more.size() % 4) % 4, '\0');
    doc["accessors"].push_back({{"bufferView", doc["bufferViews"].size() - 1},
                                {"componentType", component},
                                {"type", type},
                                {"count", values.size() / components},
                                {"normalized", normalized}});
    return static_cast<int>(doc["accessors"].size()) - 1;
  }
  int floats(const char* type, std::size_t components, const std::vector<float>& values) {
    return add(type, components, 5126, values);
  }
  Json& attributes() { return doc["meshes"][0]["primitives"][0]["attributes"]; }
  Json& primitive() { return doc["meshes"][0]["primitives"][0]; }

  [[nodiscard]] std::string text() const {
    Json all = doc;
    all["buffers"] = {
        {{"byteLength", data_.size()}, {"uri", "data:application/octet-stream;base64," + test::base64(data_)}}};
    return all.dump();
  }
  [[nodiscard]] Scene load() const {
    const test::TempDirectory dir;
    return Scene::load(dir.write("s.gltf", text()));
  }
  [[nodiscard]] std::string refusal() const {
    const test::TempDirectory dir;
    const std::string file = dir.write("s.gltf", text());
    const std::string message = test::refusal(file);
    return message.rfind(file + ": ", 0) == 0 ? message.substr(file.size() + 2) : message;
  }
  [[nodiscard]] glm::dvec3 vertex(std::size_t i, int frame = 0, int frames = 1) const {
    return load().frame(frame, frames).vertices[i];
  }

 private:
  std::string data_;
};

void check_near(const glm::dvec3& a, const glm::dvec3& b) {
  CAPTURE(a.x, a.y, a.z, b.x, b.y, b.z);
  CHECK(kage::length(a - b) < 1e-6);
}

/// A triangle whose three corners hang on joint 0 (node 1), all at weight 1, in a node that lies far away.
File skinned() {
  File f;
  f.attributes()["POSITION"] = f.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  f.attributes()["JOINTS_0"] = f.add<std::uint8_t>("VEC4", 4, 5121, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  f.attributes()["WEIGHTS_0"] = f.floats("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  f.doc["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0, "translation": [-50, 0, 0]}, {"translation": [2, 0, 0]}])");
  f.doc["skins"] = Json::parse(R"([{"joints": [1]}])");
  return f;
}

/// Joint 1 (node 2, a child of node 1, at its place (0, 3, 0)) has part of each corner.
File two_joints() {
  File f = skinned();
  f.doc["nodes"] =
      Json::parse(R"([{"mesh": 0, "skin": 0, "scale": [9, 9, 9]}, {"translation": [2, 0, 0], "children": [2]},
      {"translation": [0, 3, 0]}])");
  f.doc["skins"][0]["joints"] = {1, 2};
  return f;
}

/// A triangle whose morph target 0 moves it up by 1, and target 1 its first corner by 4.
File morphed() {
  File f;
  f.attributes()["POSITION"] = f.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  f.primitive()["targets"] = {{{"POSITION", f.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1})}},
                              {{"POSITION", f.floats("VEC3", 3, {4, 0, 0, 0, 0, 0, 0, 0, 0})}}};
  return f;
}

void animate(File& f, int node, const char* path, const std::vector<float>& values, const char* type,
             std::size_t components, const char* interpolation = "LINEAR") {
  const int times = f.floats("SCALAR", 1, {0, 1});
  const int keys = f.floats(type, components, values);
  f.doc["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
                          {"samplers", {{{"input", times}, {"output", keys}, {"interpolation", interpolation}}}}}};
}

}  // namespace

TEST_CASE("a skin's joints place the mesh, not its node") {
  const File f = skinned();
  check_near(f.vertex(0), {2, 0, 0});
  check_near(f.vertex(2), {2, 1, 0});
  const Scene s = f.load();
  for (const char* word : {"skin", "rest pose", "JOINTS", "WEIGHTS"}) CHECK_FALSE(test::has_note(s, word));
  CHECK(s.frame(0, 1).components[0].convex == false);
}

TEST_CASE("inverse bind matrices lead from the mesh to the joint") {
  File f = skinned();
  f.doc["skins"][0]["inverseBindMatrices"] = f.floats("MAT4", 16, {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1});
  check_near(f.vertex(0), {7, 6, 7});
  check_near(f.vertex(1), {7, 8, 7});
  check_near(f.vertex(2), {5, 6, 7});
  f.doc["accessors"].back()["count"] = 1;
  f.doc["skins"][0]["joints"] = {1, 0};
  CHECK(f.refusal() == "skin 0: has fewer inverse bind matrices than joints");
  File projective = skinned();
  projective.doc["skins"][0]["inverseBindMatrices"] =
      projective.floats("MAT4", 16, {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
  CHECK(projective.refusal() == "skin 0: a matrix is projective: its last row is not 0, 0, 0, 1");
}

TEST_CASE("weights of every type, of one set and of two, whatever their sum") {
  const auto corner = [](const File& f) { return f.vertex(0); };
  for (const int joint_type : {5121, 5123}) {
    const auto with = [&](auto add_weights) {
      File f = two_joints();
      f.attributes()["JOINTS_0"] = joint_type == 5121
                                       ? f.add<std::uint8_t>("VEC4", 4, 5121, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0})
                                       : f.add<std::uint16_t>("VEC4", 4, 5123, {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
      f.attributes()["WEIGHTS_0"] = add_weights(f);
      return f;
    };
    check_near(corner(with([](File& f) {
                 return f.floats("VEC4", 4, {0.75F, 0.25F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
               })),
               {2, 0.75, 0});
    check_near(corner(with([](File& f) {
                 return f.floats("VEC4", 4, {3, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
               })),
               {2, 0.75, 0});
    check_near(corner(with([](File& f) {
                 return f.add<std::uint8_t>("VEC4", 4, 5121, {51, 204, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, true);
               })),
               {2, 2.4, 0});
    check_near(
        corner(with([](File& f) {
          return f.add<std::uint16_t>("VEC4", 4, 5123, {13107, 52428, 0, 0, 65535, 0, 0, 0, 65535, 0, 0, 0}, true);
        })),
        {2, 2.4, 0});
  }
  File f = two_joints();
  f.attributes()["JOINTS_1"] = f.add<std::uint8_t>("VEC4", 4, 5121, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  f.attributes()["WEIGHTS_0"] = f.floats("VEC4", 4, {0.5F, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0});
  f.attributes()["WEIGHTS_1"] = f.floats("VEC4", 4, {0.5F, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  check_near(f.vertex(0), {2, 1.5, 0});
  check_near(f.vertex(1), {3, 0, 0});
  check_near(f.vertex(2), {2, 4, 0});
}

TEST_CASE("a joint that moves takes the mesh along; the bounds are those of what is seen") {
  File f = skinned();
  animate(f, 1, "translation", {2, 0, 0, 2, 8, 0}, "VEC3", 3);
  check_near(f.vertex(0, 0, 2), {2, 0, 0});
  check_near(f.vertex(0, 1, 2), {2, 4, 0});
  const SceneFrame frame = f.load().frame(0, 8);
  CHECK(kage::length(frame.camera.eye - glm::dvec3{2.5, 4, 0}) < 30);  // not 50 away, where the node is
}

TEST_CASE("normals turn with the joints; those of faces are made anew") {
  File f = skinned();
  f.doc["nodes"][1] =
      Json::parse(R"({"rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "scale": [1, 1, 5]})");
  for (const bool own : {false, true}) {
    if (own) f.attributes()["NORMAL"] = f.floats("VEC3", 3, {0, 0, 2, 0, 0, 2, 0, 0, 2});
    const SceneFrame frame = f.load().frame(0, 1);
    check_near(frame.shading[frame.triangles[0].shading[0]].normal, {1, 0, 0});
  }
  f.attributes()["NORMAL"] = f.floats("VEC3", 3, {1, 0, 1, 0, 0, 1, 0, 0, 1});
  const SceneFrame frame = f.load().frame(0, 1);
  check_near(frame.shading[frame.triangles[0].shading[0]].normal, glm::dvec3{0.2, 0, -1} / std::sqrt(1.04));
}

TEST_CASE("a joint that mirrors turns the triangles") {
  File f = skinned();
  f.doc["nodes"][1]["scale"] = {-1, 1, 1};
  const SceneFrame frame = f.load().frame(0, 1);
  const Triangle& t = frame.triangles[0];
  const glm::dvec3 u = frame.vertices[t.vertex[1]] - frame.vertices[t.vertex[0]];
  const glm::dvec3 v = frame.vertices[t.vertex[2]] - frame.vertices[t.vertex[0]];
  CHECK(u.x * v.y - u.y * v.x > 0);
  check_near(frame.shading[t.shading[0]].normal, {0, 0, 1});
}

TEST_CASE("vertices at one place that hang on different joints part") {
  File f = two_joints();
  f.attributes()["POSITION"] = f.floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, -1, 0});
  f.attributes()["JOINTS_0"] =
      f.add<std::uint8_t>("VEC4", 4, 5121, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  f.attributes()["WEIGHTS_0"] =
      f.floats("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const SceneFrame frame = f.load().frame(0, 1);
  CHECK(frame.vertices.size() == 5);
  check_near(frame.vertices[3], {2, 3, 0});
}

TEST_CASE("morph targets: weights of the mesh, of the node, and of an animation") {
  File f = morphed();
  check_near(f.vertex(0), {0, 0, 0});
  CHECK(f.load().frame(0, 1).components.size() == 1);
  f.doc["meshes"][0]["weights"] = {0.5, 0};
  check_near(f.vertex(0), {0, 0, 0.5});
  f.doc["nodes"][0]["weights"] = {1, 0.25};
  check_near(f.vertex(0), {1, 0, 1});
  check_near(f.vertex(1), {1, 0, 1});
  f.doc["nodes"][0]["translation"] = {0, 0, 7};
  check_near(f.vertex(1), {1, 0, 8});
  CHECK_FALSE(test::has_note(f.load(), "morph"));
  for (const auto& [interpolation, half] : {std::pair{"LINEAR", 1.0}, {"STEP", 0.0}}) {
    animate(f, 0, "weights", {0, 0, 2, 1}, "SCALAR", 1, interpolation);
    check_near(f.vertex(0, 1, 2), {2 * half, 0, 7 + half});
  }
  animate(f, 0, "weights", {0, 0, 0, 0, 0, 0, 0, 0, 2, 1, 0, 0}, "SCALAR", 1, "CUBICSPLINE");
  check_near(f.vertex(0, 1, 2), {2, 0, 8});
  f.doc["animations"][0]["channels"][0]["target"]["node"] = 1;
  CHECK(test::has_note(f.load(), "1 morph animation is ignored: the mesh has no morph targets"));
  f.doc["nodes"][0]["weights"] = {1};
  CHECK(f.refusal() == "node 0: 'weights' is not 2 numbers");
}

TEST_CASE("morph targets: sparse ones, quantised ones, their normals, and under a skin") {
  File f = morphed();
  f.doc["meshes"][0]["weights"] = {1, 0};
  const int where = f.add<std::uint16_t>("SCALAR", 1, 5123, {1});
  const int what = f.floats("VEC3", 3, {0, 0, 6});
  f.doc["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
  f.doc["accessors"].back()["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", f.doc["accessors"][static_cast<std::size_t>(where)]["bufferView"]}, {"componentType", 5123}}},
      {"values", {{"bufferView", f.doc["accessors"][static_cast<std::size_t>(what)]["bufferView"]}}}};
  f.primitive()["targets"][0]["POSITION"] = f.doc["accessors"].size() - 1;
  check_near(f.vertex(0), {0, 0, 0});
  check_near(f.vertex(1), {1, 0, 6});

  File normals = morphed();
  normals.attributes()["NORMAL"] = normals.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1});
  normals.primitive()["targets"][0]["NORMAL"] = normals.floats("VEC3", 3, {1, 0, 0, 1, 0, 0, 1, 0, 0});
  normals.doc["meshes"][0]["weights"] = {1, 0};
  const SceneFrame frame = normals.load().frame(0, 1);
  check_near(frame.shading[frame.triangles[0].shading[0]].normal, glm::dvec3{1, 0, 1} / std::sqrt(2.0));

  File both = skinned();
  both.primitive()["targets"] = {{{"POSITION", both.floats("VEC3", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1})}}};
  both.doc["nodes"][0]["weights"] = {3};
  both.doc["nodes"][1]["scale"] = {1, 1, 2};
  check_near(both.vertex(1), {3, 0, 6});  // first the target, then the joint
}

TEST_CASE("skins and targets that cannot be are refused with their place, those without effect told") {
  const auto with = [](auto change) {
    File f = skinned();
    change(f);
    return f.refusal();
  };
  CHECK(with([](File& f) { f.doc["nodes"][0]["skin"] = 3; }) == "node 0: asks for number 3 of 1 skins");
  CHECK(with([](File& f) { f.doc["skins"][0]["joints"] = Json::array(); }) == "skin 0: has no joints");
  CHECK(with([](File& f) { f.doc["skins"][0]["joints"] = {9}; }) == "skin 0: joint node 9 is not in the scene");
  CHECK(with([](File& f) { f.attributes().erase("WEIGHTS_0"); }) ==
        "mesh 0 primitive 0: has joints without weights, or weights without joints");
  CHECK(with([](File& f) {
          f.attributes()["JOINTS_0"] = f.add<std::uint8_t>("VEC4", 4, 5121, {0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0});
        }) == "node 0: its mesh names joint 7 of 1");
  CHECK(with([](File& f) {
          f.attributes()["WEIGHTS_0"] = f.floats("VEC4", 4, {1, 0, 0, 0, -1, 0, 0, 0, 1, 0, 0, 0});
        }) == "mesh 0 primitive 0: a joint's weight is negative or not finite");
  CHECK(with([](File& f) {
          f.attributes()["WEIGHTS_0"] = f.floats("VEC4", 4, {1, 0, 0, 0});
        }) == "mesh 0 primitive 0: has more or fewer joints or weights than positions");
  CHECK(with([](File& f) {
          f.attributes()["JOINTS_0"] = f.attributes()["WEIGHTS_0"];
        }).find("component type 5126 (float), which JOINTS cannot have") != std::string::npos);
  // A joint that is not there, at weight 0.
  CHECK(with([](File& f) {
          f.attributes()["JOINTS_0"] = f.add<std::uint8_t>("VEC4", 4, 5121, {0, 9, 9, 9, 0, 9, 9, 9, 0, 9, 9, 9});
        }) == "loaded");
  File f = skinned();
  f.attributes()["WEIGHTS_0"] = f.floats("VEC4", 4, {1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  CHECK(test::has_note(f.load(), "1 vertex of a skinned mesh has no weights: the first joint moves it"));
  check_near(f.vertex(1), {3, 0, 0});
  f.attributes().erase("WEIGHTS_0");
  f.attributes().erase("JOINTS_0");
  CHECK(test::has_note(f.load(), "1 skin is ignored: the mesh has no joints"));
  check_near(f.vertex(0), {-50, 0, 0});
  File m = morphed();
  m.primitive()["targets"][1]["POSITION"] = m.floats("VEC3", 3, {0, 0, 0});
  CHECK(m.refusal() == "mesh 0 primitive 0 target 1: has more or fewer values than the primitive positions");
}
