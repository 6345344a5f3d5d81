// SPDX-License-Identifier: Apache-2.0
#include "scene/animation.hpp"

#include <cmath>

#include "files.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::scene;
using test::TempDirectory;

namespace {

RawTrack track(RawPath path, RawInterpolation interpolation, std::vector<double> times, std::vector<double> values) {
  RawTrack t;
  t.path = path;
  t.interpolation = interpolation;
  t.times = std::move(times);
  t.values = std::move(values);
  return t;
}

bool near(const glm::dvec3& a, const glm::dvec3& b) { return length(a - b) < 1e-12; }

}  // namespace

TEST_CASE("linear keys: between, on and beyond them") {
  const RawTrack t = track(RawPath::kTranslation, RawInterpolation::kLinear, {1, 2, 4}, {0, 0, 0, 8, 4, 2, 8, 0, 0});
  CHECK(sample(t, 0)[0] == 0);
  CHECK(sample(t, 1)[1] == 0);
  CHECK(sample(t, 1.25)[0] == 2);
  CHECK(sample(t, 1.25)[2] == 0.5);
  CHECK(sample(t, 2)[1] == 4);
  CHECK(sample(t, 3)[1] == 2);
  CHECK(sample(t, 4)[0] == 8);
  CHECK(sample(t, 99)[0] == 8);
}

TEST_CASE("step keys hold until the next") {
  const RawTrack t = track(RawPath::kScale, RawInterpolation::kStep, {0, 1}, {1, 1, 1, 3, 3, 3});
  CHECK(sample(t, 0.999)[0] == 1);
  CHECK(sample(t, 1)[0] == 3);
}

TEST_CASE("cubic keys follow their tangents") {
  // Hermite from 0 to 1 over 2 s with slopes 0.5 and 0.5 is the straight line.
  const RawTrack t = track(RawPath::kTranslation, RawInterpolation::kCubic, {0, 2},
                           {0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0.5, 0, 0, 1, 4, 0, 0, 0, 0});
  CHECK(sample(t, 1)[0] == Approx(0.5).epsilon(1e-15));
  CHECK(sample(t, 0.5)[0] == Approx(0.25).epsilon(1e-15));
  CHECK(sample(t, 1)[1] == Approx(2).epsilon(1e-15));  // no slopes: 4 (3 u^2 - 2 u^3)
  CHECK(sample(t, 0.5)[1] == Approx(4 * (3.0 / 16 - 2.0 / 64)).epsilon(1e-15));
}

TEST_CASE("rotations come normalised, and turn") {
  const RawTrack t = track(RawPath::kRotation, RawInterpolation::kLinear, {0, 1}, {0, 0, 0, 2, 0, 0, 2, 0});
  CHECK(sample(t, 0)[3] == 1);
  CHECK(sample(t, 1)[2] == 1);
  CHECK(sample(t, 0.5)[2] == Approx(std::sqrt(0.5)).epsilon(1e-15));
}

TEST_CASE("a hierarchy moves with its parents") {
  RawScene s;
  s.nodes.resize(3);
  s.nodes[0].fixed = false;
  s.nodes[0].translation = {10, 0, 0};
  s.nodes[1].parent = 0;
  s.nodes[1].fixed = false;
  s.nodes[1].scale = {2, 2, 2};
  s.nodes[2].parent = 1;
  s.nodes[2].matrix.origin = {1, 0, 0};
  RawTrack turn =
      track(RawPath::kRotation, RawInterpolation::kLinear, {0, 2}, {0, 0, 0, 1, 0, 0, 1, 0});  // half a turn about z
  s.tracks.push_back(turn);
  CHECK(end_time(s) == 2);
  // The child at (1 0 0), scaled by 2, lies 2 away from (10 0 0), in the direction turned by a right angle a second.
  CHECK(near(pose(s, 0)[2].origin, {12, 0, 0}));
  CHECK(near(pose(s, 1)[2].origin, {10, 2, 0}));
  CHECK(near(pose(s, 2)[2].origin, {8, 0, 0}));
  CHECK(near(pose(s, 1)[2].vector({0, 0, 1}), {0, 0, 2}));
}

TEST_CASE("frames divide the animation from its start, the end left out") {
  // Translation keys at 0 and 4 s: 0 and 8 in x.
  const std::vector<float> data{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 4, 0, 0, 0, 8, 0, 0};
  const TempDirectory dir;
  const std::string path = dir.write("move.gltf", test::gltf(R"(
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                      {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR"},
                    {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
      "nodes": [{"mesh": 0, "name": "mover"}],
      "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                      "samplers": [{"input": 1, "output": 2}]}, {"channels": [], "samplers": []}],
      "scenes": [{"nodes": [0]}])",
                                                             test::bytes_of(data)));
  const Scene scene = Scene::load(path);
  CHECK(scene.frame_count() == 8);
  CHECK(test::has_note(scene, "1 animation is ignored"));
  for (const int count : {1, 2, 8, 64})
    for (int i = 0; i < count; ++i) CHECK(scene.frame(i, count).vertices[0].x == 8.0 * i / count);
  CHECK_THROWS_AS(scene.frame(8, 8), Error);
  CHECK_THROWS_AS(scene.frame(-1, 8), Error);
  CHECK_THROWS_AS(scene.frame(0, 0), Error);
  // The orbit's ball holds the triangle wherever it moves.
  const Camera c = scene.frame(7, 8).camera;
  for (const glm::dvec3& v : scene.frame(7, 8).vertices) {
    const glm::dvec3 d = v - c.eye;
    CHECK(dot(d, c.forward) > c.near);
    CHECK(std::abs(dot(d, c.up)) < c.half_height * dot(d, c.forward));
    CHECK(std::abs(dot(d, c.right)) < c.half_height * dot(d, c.forward));
  }
}
