// SPDX-License-Identifier: Apache-2.0
// Family 10: NaN, infinity, denormals: diagnosed, nothing written. verif/test/unit/scene/import.cpp has the same for
// files.
#include <cmath>
#include <limits>

#include "extremes/numbers.hpp"
#include "kage/error.hpp"
#include "oracle/judge.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
TEST_CASE("family 10: a position, camera or light that is not finite is an error that says which") {
  using Catch::Matchers::ContainsSubstring;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    const auto said = [bad](auto spoil) {
      SceneFrame f = plain_scene();
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
    // Each kind of light: the numbers that count for it, and only those.
    const auto of_light = [&](bool directional, auto spoil) {
      return said([&](SceneFrame& f, double v) {
        f.lights.push_back({});
        Light& l = f.lights[1];
        l.directional = directional;
        l.spot = l.falls_off = true;
        l.shape = LightShape::disc;
        l.position = {1, 3, 2};
        l.axis_u = l.axis_v = {1, 0, 0};
        spoil(l, v);
      });
    };
    const bool is_inf = bad == inf;  // a range without end is one
    for (const bool directional : {true, false}) {
      CAPTURE(directional);
      const char* placed = directional ? "accepted" : "light 1: ";
      const auto check = [&](auto spoil, const char* says) {
        CHECK_THAT(of_light(directional, spoil), ContainsSubstring(says));
      };
      check([](Light& l, double v) { l.direction.z = v; }, "light 1: its direction");
      check([](Light& l, double v) { l.color.y = v; }, "light 1: its colour");
      check([](Light& l, double v) { l.position.x = v; }, placed);
      check([](Light& l, double v) { l.axis_u.y = v; }, placed);
      check([](Light& l, double v) { l.axis_v.z = v; }, placed);
      check([](Light& l, double v) { l.inner_cosine = v; }, placed);
      check([](Light& l, double v) { l.outer_cosine = v; }, placed);
      check([](Light& l, double v) { l.range = v; }, is_inf ? "accepted" : placed);
    }
  }
  for (const int size : {0, -1, kMaxSize + 1, 1 << 30}) {
    CHECK_THROWS_AS(make_geometry(plain_scene(), Config{}, size, 48), Error);
    CHECK_THROWS_AS(make_geometry(plain_scene(), Config{}, 64, size), Error);
  }
  CHECK_THROWS_AS(make_geometry(SceneFrame{}, Config{}, 64, 48), Error);
}

TEST_CASE("family 10: a light, or a look, beyond what can be drawn is an error that says so") {
  using Catch::Matchers::ContainsSubstring;
  Config config;
  config.count_bits = 8;
  const auto light = [&](auto change) {
    SceneFrame f = plain_scene();
    f.lights[0].directional = false;
    f.lights[0].position = {3, 5, 2};
    change(f.lights[0]);
    try {
      (void)make_geometry(f, config, 64, 48);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  CHECK(light([](Light&) {}) == "accepted");
  CHECK_THAT(light([](Light& l) { l.color.x = -1; }), ContainsSubstring("colour"));
  CHECK_THAT(light([](Light& l) { l.range = -1; }), ContainsSubstring("range"));
  CHECK_THAT(light([](Light& l) { l.directional = true, l.direction = {0, 0, 0}; }), ContainsSubstring("direction"));
  CHECK_THAT(light([](Light& l) { l.directional = true, l.direction = {0, -2, 0}; }), ContainsSubstring("direction"));
  CHECK_THAT(light([](Light& l) { l.spot = true, l.inner_cosine = 0.2, l.outer_cosine = 0.3; }),
             ContainsSubstring("cone"));
  // The scene is some 12 across.
  for (const double far : {1e6, 1e12}) {
    CHECK(light([far](Light& l) { l.position *= far; }) == "accepted");
    CHECK(light([far](Light& l) { l.shape = LightShape::sphere, l.axis_u = {far, 0, 0}; }) == "accepted");
  }
  for (const double far : {1e14, 1e200}) {
    CHECK_THAT(light([far](Light& l) { l.position *= far; }), ContainsSubstring("make it directional"));
    CHECK_THAT(light([far](Light& l) {
                 l.shape = LightShape::sphere, l.axis_u = {far, 0, 0};
               }),
               ContainsSubstring("make it directional"));
  }
  const auto look = [](auto change) {
    Look l;
    change(l);
    return make_geometry(plain_scene(), Config{}, 64, 48, {.look = l});
  };
  CHECK_THROWS_AS(look([](Look& l) { l.samples = 0; }), Error);
  CHECK_THROWS_AS(look([](Look& l) { l.samples = 256; }), Error);
  CHECK_THROWS_AS(look([](Look& l) { l.classes = 0; }), Error);
  CHECK_THROWS_AS(look([](Look& l) { l.classes = 2048; }), Error);
  CHECK_THROWS_AS(look([](Look& l) { l.max_shading = -1; }), Error);
  CHECK_THROWS_AS(look([](Look& l) { l.max_shading = 256; }), Error);
  CHECK_THROWS_AS(look([](Look& l) { l.darkening = NAN; }), Error);
  CHECK_THROWS_AS(look([](Look& l) { l.extrusion = 0.5; }), Error);
}

TEST_CASE("family 10: denormal, tiny and huge coordinates draw what the oracle says") {
  for (const double scale : {1e-300, 1e-30, 1e-6, 1e6, 1e15, 1e30}) {
    CAPTURE(scale);
    SceneFrame f = plain_scene();
    for (glm::dvec3& p : f.vertices) p *= scale;
    f.camera.eye *= scale;
    f.camera.near *= scale;
    const Judgement j = judge(make_geometry(f, Config{}, 64, 48), Config{});
    INFO(j.text());
    CHECK(j.good());
  }
  SceneFrame f = plain_scene();
  f.vertices[0].x = std::numeric_limits<double>::denorm_min();
  CHECK(judge(make_geometry(f, Config{}, 64, 48), Config{}).good());
}

}  // namespace kage::verif
