// SPDX-License-Identifier: Apache-2.0
// The remarks on a picture: steps of depth that are long, things beyond the far plane, backs of faces.
#include "geometry/remarks.hpp"

#include <cmath>

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

TEST_CASE("a step of depth longer than 1e-4 of the scene's extent is told, with the width that would do") {
  // A wall 7 from the eye, and a box around `far`: its back is the furthest surface, depth begins at 4, and a step
  // there is far^2 / (4 (2^24 - 3)) (1 - 4 / far).
  const auto with_box = [](double far) {
    SceneFrame f = wall();
    add_solid(f, box_solid(), {0, 0, 7 - far + 1}, {1, 1, 1}, Turn{}, {1, 1, 1});
    return f;
  };
  const auto step = [](double far, int z_bits) { return far * (far - 4) / 4 / (std::ldexp(1.0, z_bits) - 3); };
  for (const double far : {100.0, 5000.0, 6000.0, 1e5})
    for (const int z_bits : {16, 20, 24, 28}) {
      CAPTURE(far, z_bits);
      Config config;
      config.z_bits = z_bits;
      const SceneFrame f = with_box(far);
      const double extent = std::sqrt(8 + far * far);  // of a box 2 wide, from the wall, at 7, to far behind it
      const Remarks r = look(f, config);
      // The far end lies 1e-6 past the furthest vertex.
      const double long_step = 1e-4 * extent;
      if (step(far, z_bits) < long_step * 0.99) CHECK(r.step == 0);
      if (step(far, z_bits) < long_step * 1.01) continue;
      CHECK(r.step == Approx(step(far, z_bits)).epsilon(1e-5));
      CHECK(r.furthest == Approx(far).epsilon(1e-9));
      CHECK(r.extent == Approx(extent).epsilon(0.1));
      // One bit fewer would not do, so many do.
      const double most = 1e-4 * r.extent;
      if (r.z_bits_needed == 0) {
        CHECK(step(far, 28) > most * 0.999);
      } else {
        CHECK(step(far, r.z_bits_needed) <= most * 1.001);
        CHECK(step(far, r.z_bits_needed - 1) > most * 0.999);
      }
    }
  // However near the near plane is, depth begins at what is seen.
  SceneFrame f = with_box(100);
  f.camera.near = 1e-9;
  CHECK(look(f).step == 0);
  // In parallel view steps have one length. Depth begins at 0 at the latest and ends at 100, and the scene's extent is
  // 96 or so: at 1e-4 of it between 9,600 and 10,420 steps, for which 14 bits do.
  f.camera.perspective = false;
  f.camera.half_height = 3;
  Config coarse;
  coarse.z_bits = 8;
  const Remarks r = look(f, coarse);
  CHECK(r.extent == Approx(93).epsilon(0.05));
  CHECK(r.step >= (100.0 - 7) / 253);
  CHECK(r.step <= 100.0 / 253 * (1 + 1e-5));
  CHECK(r.z_bits_needed == 14);
  coarse.z_bits = 14;
  CHECK(look(f, coarse).step == 0);
}

TEST_CASE("what counts for a step is what the picture shows") {
  Config config;
  config.z_bits = 16;
  SceneFrame f = wall();
  add_solid(f, box_solid(), {0, 5000, -10000}, {1, 1, 1}, Turn{}, {1, 1, 1});  // above the picture
  add_solid(f, box_solid(), {0, 0, 5000}, {1, 1, 1}, Turn{}, {1, 1, 1});       // behind the eye
  CHECK(look(f, config).step == 0);
  add_solid(f, box_solid(), {0, 0, -9000}, {1, 1, 1}, Turn{}, {1, 1, 1}, true, true, 0);  // of alpha 0
  config.translucency = 1;
  CHECK(look(f, config).step == 0);
  config.translucency = 0;  // drawn as if opaque
  CHECK(look(f, config).furthest == Approx(9008).epsilon(1e-9));
}

TEST_CASE("built-in scenes give no remark, in any configuration that draws them at full size") {
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    for (const NamedConfig& named : named_configs()) {
      if (named.name == "tiny") continue;  // 160 pixels at most
      for (int i = 0; i < scene.frame_count(); ++i) {
        INFO(name << " " << named.name << " " << i);
        const Remarks r = look(scene.frame(i, scene.frame_count()), named.config);
        CHECK(r.step == 0);
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
