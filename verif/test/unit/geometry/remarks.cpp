// SPDX-License-Identifier: Apache-2.0
// What is told of a picture: a near plane so near that depth is coarse, things beyond the far plane, backs of faces.
#include "geometry/remarks.hpp"

#include "kage/config.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// A wall of glass or stone across the view, 7 before the eye, and a floor that the eye stands on.
SceneFrame wall() {
  SceneFrame f;
  add_solid(f, pane_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  look_at(f.camera, {0, 0, 7}, {0, 0, 0});
  f.camera.half_height = 0.4;
  f.camera.near = 0.1;
  return f;
}

Remarks look(const SceneFrame& f, const Config& config = {}) { return remarks(f, config, kWidth, kHeight); }

}  // namespace

TEST_CASE("a near plane too near: from where two steps at the nearest surface are longer than a pixel is wide") {
  SceneFrame f = wall();
  CHECK(look(f).nearest == 0);
  // Steps from w to infinity are (2^24 - 3) n / w, all of them for a near plane far from the furthest vertex; what is
  // needed is 480 / 0.4 = 1200 of them: n = 7 * 1200 / 16777213 = 0.00050068.
  f.camera.near = 0.000501;
  CHECK(look(f).nearest == 0);
  f.camera.near = 0.000500;
  Remarks r = look(f);
  CHECK(r.nearest == Approx(7).epsilon(1e-12));
  CHECK(r.steps == Approx(1198.4).epsilon(1e-4));
  CHECK(r.near_needed == Approx(0.00050065).epsilon(1e-4));
  f.camera.near = r.near_needed * 1.0001;
  CHECK(look(f).nearest == 0);
  f.camera.near = 1e-6;
  r = look(f);
  CHECK(r.steps == Approx(2.3967).epsilon(1e-4));
  // The same for depth of 16 bits, at once.
  f.camera.near = 0.1;
  Config coarse;
  coarse.z_bits = 16;
  CHECK(look(f, coarse).nearest != 0);
  // Where no near plane would do it is not the near plane's fault.
  coarse.z_bits = 8;
  add_solid(f, box_solid(), {0, 0, -1000}, {1, 1, 1}, Turn{}, {1, 1, 1});
  CHECK(look(f, coarse).nearest == 0);
  // A parallel view has steps of one length.
  f.camera.near = 1e-6;
  f.camera.perspective = false;
  CHECK(look(f).nearest == 0);
}

TEST_CASE("what counts is what the picture shows") {
  SceneFrame f = wall();
  f.camera.near = 1e-6;
  const auto add = [&](const glm::dvec3& at, std::uint8_t alpha) {
    add_solid(f, box_solid(), at, glm::dvec3(0.001), Turn{}, {1, 1, 1}, true, true, alpha);
  };
  add({0, 5, 6.999}, 255);  // beside the view
  add({0, 0, 7.1}, 255);    // behind the eye
  add({0, 0, 6.99}, 0);     // not to be seen
  CHECK(look(f).nearest == Approx(7).epsilon(1e-12));
  // A long floor begins where the picture's lower edge meets it, a unit below the eye: 1 / 0.4 away.
  add_solid(f, pane_solid(), {0, -1, 0}, {100, 100, 1}, Turn{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {1, 1, 1}, false,
            false);
  CHECK(look(f).nearest == Approx(2.5).epsilon(1e-9));
  // Near enough for the near plane: 0.01 away there are 1677 steps.
  add({0, 0, 6.989}, 255);
  CHECK(look(f).nearest == 0);
}

TEST_CASE("built-in scenes give no remark, in any configuration that draws them at full size") {
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    for (const NamedConfig& named : named_configs()) {
      if (named.name == "tiny") continue;  // 160 pixels at most
      for (int i = 0; i < scene.frame_count(); ++i) {
        INFO(name << " " << named.name << " " << i);
        const Remarks r = look(scene.frame(i, scene.frame_count()), named.config);
        CHECK(r.nearest == 0);
        CHECK_FALSE(r.beyond_far);
        CHECK_FALSE(r.backs);
      }
    }
  }
}

TEST_CASE("what lies beyond the far plane is told if the picture shows it") {
  SceneFrame f = wall();
  for (const auto& [far, beyond] : {std::pair{0.0, false}, {7.0, false}, {6.9, true}, {8.0, false}}) {
    f.camera.far = far;
    CHECK(look(f).beyond_far == beyond);
  }
  f.camera.far = 8;
  add_solid(f, box_solid(), {0, 500, -50}, {1, 1, 1}, Turn{}, {1, 1, 1});
  CHECK_FALSE(look(f).beyond_far);
  add_solid(f, box_solid(), {0, 0, -50}, {1, 1, 1}, Turn{}, {1, 1, 1}, true, true, 0);
  CHECK_FALSE(look(f).beyond_far);
  f.camera.perspective = false;
  f.camera.half_height = 2;
  CHECK_FALSE(look(f).beyond_far);
  add_solid(f, box_solid(), {0, 0, -50}, {1, 1, 1}, Turn{}, {1, 1, 1});
  CHECK(look(f).beyond_far);
}

TEST_CASE("backs of single-sided faces are told where they can be seen") {
  const auto backs = [](const Solid& solid, bool closed, Sides sides, const glm::dvec3& eye, std::uint8_t alpha = 255) {
    SceneFrame f;
    add_solid(f, solid, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, closed, closed, alpha);
    for (Triangle& t : f.triangles) t.sides = sides;
    look_at(f.camera, eye, eye + glm::dvec3(0.1, 0.2, -1));
    f.camera.half_height = 1;
    f.camera.near = 0.01;
    bool both = false;
    for (const bool perspective : {true, false}) {
      f.camera.perspective = perspective;
      const bool seen = look(f).backs;
      if (perspective) both = seen;
      // Parallel views of a scene from within see what lies ahead too.
      if (eye != glm::dvec3(0)) CHECK(seen == both);
    }
    return both;
  };
  const glm::dvec3 front{0, 0, 3};
  CHECK_FALSE(backs(pane_solid(), false, Sides::front, front));
  CHECK(backs(pane_solid(), false, Sides::back, front));
  CHECK_FALSE(backs(pane_solid(), false, Sides::both, front));
  CHECK_FALSE(backs(box_solid(), true, Sides::front, front));
  CHECK(backs(box_solid(), true, Sides::back, front));        // inside out in the file: its inside is meant to be seen
  CHECK(backs(box_solid(), true, Sides::front, front, 100));  // through its front
  CHECK(backs(box_solid(), true, Sides::front, {0, 0, 0}));   // from within
  CHECK_FALSE(backs(box_solid(), true, Sides::back, {0, 0, 0}));
}

}  // namespace kage::verif
