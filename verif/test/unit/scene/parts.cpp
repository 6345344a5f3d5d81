// SPDX-License-Identifier: Apache-2.0
// Scenes of a program's own parts: what a file of the same says, frame by frame; changing cameras and lights; what is
// no scene.
#include <cmath>
#include <functional>
#include <limits>

#include "files.hpp"
#include "kage/config.hpp"
#include "kage/error.hpp"
#include "kage/pipeline.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using test::TempDirectory;

namespace {

const std::vector<std::array<std::uint32_t, 3>> kBoxFaces{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                                          {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                                          {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};

/// A box of corners whose coordinates decimal fractions hold.
SceneObject box(const std::string& name, glm::vec3 low, glm::vec3 high) {
  SceneObject o;
  o.name = name;
  for (const float z : {low.z, high.z})
    for (const auto& [x, y] : {std::pair(low.x, low.y), {high.x, low.y}, {high.x, high.y}, {low.x, high.y}})
      o.positions.emplace_back(x, y, z);
  o.triangles = kBoxFaces;
  return o;
}

/// A floor, a red box on it, and a box of green glass with one blue face.
SceneParts three() {
  SceneParts parts;
  parts.name = "three";
  parts.materials = {{.color = {0.75, 0.75, 0.75}},
                     {.color = {1, 0.25, 0.25}},
                     {.color = {0.25, 1, 0.25}, .alpha = 0.5},
                     {.color = {0.25, 0.25, 1}}};
  parts.objects = {box("floor", {-4, -0.5, -4}, {4, 0, 4}), box("red", {-2, 0, -1}, {-0.5, 1.5, 1}),
                   box("glass", {0.5, 0, -1}, {2, 1.5, 1})};
  for (std::size_t i = 0; i < 3; ++i)
    parts.objects[i].materials.assign(kBoxFaces.size(), static_cast<std::uint32_t>(i));
  parts.objects[2].materials[2] = parts.objects[2].materials[3] = 3;
  return parts;
}

/// The same as an OBJ file, with its materials.
Scene of_file(const TempDirectory& dir, const SceneParts& parts) {
  std::string mtl;
  for (std::size_t i = 0; i < parts.materials.size(); ++i) {
    const Material& m = parts.materials[i];
    mtl += "newmtl m" + std::to_string(i) + "\nKd " + std::to_string(m.color.x) + " " + std::to_string(m.color.y) +
           " " + std::to_string(m.color.z) + "\nd " + std::to_string(m.alpha) + "\n";
  }
  (void)dir.write("three.mtl", mtl);
  std::string obj = "mtllib three.mtl\n";
  std::size_t vertices = 1;
  for (const SceneObject& o : parts.objects) {
    obj += "o " + o.name + "\n";
    for (const glm::vec3& p : o.positions)
      obj += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
    for (std::size_t i = 0; i < o.triangles.size(); ++i) {
      obj += "usemtl m" + std::to_string(o.materials[i]) + "\nf";
      for (const std::uint32_t v : o.triangles[i]) obj += " " + std::to_string(vertices + v);
      obj += '\n';
    }
    vertices += o.positions.size();
  }
  return Scene::load(dir.write("three.obj", obj));
}

DrawOptions small(int frames) {
  DrawOptions draw;
  draw.width = 96;
  draw.height = 72;
  draw.frames = frames;
  return draw;
}

/// The words of a frame of so many.
std::vector<std::uint32_t> words(Scene scene, int index, int count) {
  SceneFrames frames(std::make_shared<const Scene>(std::move(scene)), load_config("full").config, small(count));
  return frames.words(index);
}

Camera from(glm::dvec3 eye) {
  Camera c;
  c.eye = eye;
  c.forward = -eye / std::sqrt(eye.x * eye.x + eye.y * eye.y + eye.z * eye.z);
  c.half_height = 0.5;
  return c;
}

Light sun(glm::dvec3 direction) {
  Light l;
  l.direction = direction;
  return l;
}

}  // namespace

TEST_CASE("parts are what a file of the same is") {
  const TempDirectory dir;
  const SceneParts parts = three();
  const Scene file = of_file(dir, parts);
  const Scene own = Scene::from(parts);
  REQUIRE(own.name() == "three");
  REQUIRE(own.objects() == file.objects());
  REQUIRE(own.files().empty());
  REQUIRE(own.needs_smooth() == file.needs_smooth());
  for (int i = 0; i < 3; ++i) {
    const SceneFrame a = own.frame(i, 3);
    const SceneFrame b = file.frame(i, 3);
    // Vertices are numbered in another order; triangles and their corners are not.
    REQUIRE(a.triangles.size() == b.triangles.size());
    for (std::size_t t = 0; t < a.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        REQUIRE(a.vertices[a.triangles[t].vertex[k]] == b.vertices[b.triangles[t].vertex[k]]);
    REQUIRE(a.components.size() == b.components.size());
    for (std::size_t c = 0; c < a.components.size(); ++c) {
      REQUIRE(a.components[c].closed == b.components[c].closed);
      REQUIRE(a.components[c].convex == b.components[c].convex);
      REQUIRE(a.components[c].translucent == b.components[c].translucent);
    }
    REQUIRE((words(Scene::from(parts), i, 3) == words(of_file(dir, parts), i, 3)));
  }
}

TEST_CASE("cameras and lights change from frame to frame") {
  SceneParts parts = three();
  const std::vector<glm::dvec3> eyes{{6, 4, 6}, {-6, 4, 6}, {0, 8, 2}};
  const std::vector<glm::dvec3> suns{{0.6, -0.8, 0}, {0, -0.8, 0.6}, {0, -1, 0}};
  for (std::size_t i = 0; i < 3; ++i) {
    parts.cameras.push_back(from(eyes[i]));
    parts.lights.push_back({sun(suns[i])});
  }
  const Scene all = Scene::from(parts);
  REQUIRE(all.frame_count() == 3);
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    REQUIRE(all.frame(i, 3).camera.eye == eyes[at]);
    REQUIRE(all.frame(i, 3).lights.at(0).direction == suns[at]);
    REQUIRE(all.frame(2 * i + 1, 6).camera.eye == eyes[at]);  // twice as many frames
    SceneParts one = parts;
    one.cameras = {parts.cameras[at]};
    one.lights = {parts.lights[at]};
    REQUIRE(Scene::from(one).frame_count() == 1);
    REQUIRE((words(Scene::from(parts), i, 3) == words(Scene::from(one), i, 3)));
  }
  // Shadows that are kept from frame to frame are not taken for another light's.
  SceneFrames together(std::make_shared<const Scene>(Scene::from(parts)), load_config("full").config, small(3));
  for (const int i : {0, 1, 2, 0, 2, 1}) REQUIRE((together.words(i) == words(Scene::from(parts), i, 3)));
  parts.cameras.resize(1);
  REQUIRE(Scene::from(parts).frame_count() == 3);  // the lights'
  parts.lights[1].clear();
  REQUIRE(Scene::from(parts).frame(1, 3).lights.size() == 1);  // none: a directional one
  parts.lights[1] = {sun({0, -1, 0})};
  parts.lights[1][0].color = {0, 0, 0};
  REQUIRE(Scene::from(parts).frame(1, 3).lights.at(0).color == glm::dvec3(0, 0, 0));  // out, for that frame
  REQUIRE(Scene::from(parts).frame(2, 3).lights.at(0).color == glm::dvec3(1, 1, 1));
  REQUIRE_NOTHROW(words(Scene::from(parts), 1, 3));
}

TEST_CASE("what is no scene is refused by name and place") {
  const auto said = [](const std::function<void(SceneParts&)>& change) {
    SceneParts parts = three();
    parts.cameras = {from({6, 4, 6})};
    parts.lights = {{sun({0, -1, 0})}};
    change(parts);
    try {
      (void)Scene::from(parts);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("a scene");
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  CHECK(said([](SceneParts&) {}) == "a scene");
  CHECK(said([](SceneParts& p) { p.objects.clear(); }) == "three: no faces");
  CHECK(said([](SceneParts& p) { p.objects[1].triangles[4][2] = 8; }) ==
        "three: object 'red': triangle 4: vertex 8 of 8");
  CHECK(said([](SceneParts& p) { p.objects[1].positions[3].y = kNan; }) ==
        "three: object 'red': vertex 3: position is not finite");
  CHECK(said([](SceneParts& p) { p.objects[1].materials[0] = 4; }) ==
        "three: object 'red': triangle 0: material 4 of 4");
  CHECK(said([](SceneParts& p) { p.objects[1].materials.pop_back(); }) ==
        "three: object 'red': 11 materials in place of 12");
  CHECK(said([](SceneParts& p) { p.objects[1].normals.resize(7); }) == "three: object 'red': 7 normals in place of 8");
  CHECK(said([](SceneParts& p) {
          p.objects[1].colors.assign(8, {2, 0, 0});
        }) == "three: object 'red': vertex 0: colour is not in 0 .. 1");
  CHECK(said([](SceneParts& p) { p.materials[2].alpha = 0; }) == "three: material 2: alpha is not in 0 .. 1, or is 0");
  CHECK(said([](SceneParts& p) {
          p.cameras[0].forward = {0, 0, 0};
        }) == "three: camera 0: the camera has no direction");
  CHECK(said([](SceneParts& p) {
          p.cameras.resize(2, p.cameras[0]);
          p.cameras[1].up = p.cameras[1].forward;
        }) == "three: camera 1: the camera has no direction");
  CHECK(said([](SceneParts& p) { p.cameras[0].eye.x = kNan; }) == "three: camera 0: a number is not finite");
  CHECK(said([](SceneParts& p) { p.lights[0][0].color.y = -1; }) ==
        "three: lights of frame 0: light 0: color is below 0");
  CHECK(said([](SceneParts& p) { p.lights[0].assign(65, {}); }) ==
        "three: lights of frame 0: 65 lights, and at most 64 are drawn");
  CHECK(said([](SceneParts& p) {
          p.cameras.resize(2, p.cameras[0]);
          p.lights.resize(3, p.lights[0]);
        }) == "three: 2 cameras and 3 sets of lights");
}
