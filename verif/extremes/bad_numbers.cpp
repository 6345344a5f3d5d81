// SPDX-License-Identifier: Apache-2.0
// Family 10: NaN, infinity, denormals: diagnosed, nothing written. verif/unit/scene_import.cpp has the same for files.
#include <cmath>
#include <limits>

#include "catch.hpp"
#include "kage/error.hpp"
#include "scene/judge.hpp"
#include "support/shapes.hpp"

namespace kage::verif {
namespace {

SceneFrame scene() {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -2, 0}, {4, 0.2, 4}, Turn{}, {1, 1, 1});
  add_solid(f, octahedron_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  f.lights[0].direction = glm::normalize(glm::dvec3(0.3, -1, 0.2));
  look_at(f.camera, {3, 2, 4}, {0, -1, 0});
  return f;
}

}  // namespace

TEST_CASE("family 10: a position, camera or light that is not finite is an error that says which") {
  using Catch::Matchers::ContainsSubstring;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    const auto said = [bad](auto spoil) {
      SceneFrame f = scene();
      spoil(f, bad);
      try {
        (void)make_geometry(f, Config{}, 64, 48);
      } catch (const Error& e) {
        return std::string(e.what());
      }
      return std::string("accepted");
    };
    CHECK_THAT(said([](SceneFrame& f, double v) { f.vertices[5].y = v; }), ContainsSubstring("vertex 5"));
    CHECK_THAT(said([](SceneFrame& f, double v) { f.camera.eye.x = v; }), ContainsSubstring("camera"));
    CHECK_THAT(said([](SceneFrame& f, double v) { f.camera.forward.z = v; }), ContainsSubstring("camera"));
    CHECK_THAT(said([](SceneFrame& f, double v) { f.camera.half_height = v; }), ContainsSubstring("camera"));
    CHECK_THAT(said([](SceneFrame& f, double v) { f.camera.near = v; }), ContainsSubstring("camera"));
    CHECK_THAT(said([](SceneFrame& f, double v) { f.lights[0].direction.x = v; }), ContainsSubstring("light"));
  }
  for (const int size : {0, -1, kMaxSize + 1, 1 << 30}) {
    CHECK_THROWS_AS(make_geometry(scene(), Config{}, size, 48), Error);
    CHECK_THROWS_AS(make_geometry(scene(), Config{}, 64, size), Error);
  }
  CHECK_THROWS_AS(make_geometry(SceneFrame{}, Config{}, 64, 48), Error);
}

TEST_CASE("family 10: denormal, tiny and huge coordinates draw what the oracle says") {
  for (const double scale : {1e-300, 1e-30, 1e-6, 1e6, 1e15, 1e30}) {
    CAPTURE(scale);
    SceneFrame f = scene();
    for (glm::dvec3& p : f.vertices) p *= scale;
    f.camera.eye *= scale;
    f.camera.near *= scale;
    const Judgement j = judge(make_geometry(f, Config{}, 64, 48), Config{});
    INFO(j.text());
    CHECK(j.good());
  }
  SceneFrame f = scene();
  f.vertices[0].x = std::numeric_limits<double>::denorm_min();
  CHECK(judge(make_geometry(f, Config{}, 64, 48), Config{}).good());
}

}  // namespace kage::verif
