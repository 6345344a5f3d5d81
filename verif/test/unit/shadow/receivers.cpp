// SPDX-License-Identifier: Apache-2.0
// Shadows that are left out are those that nothing seen could show.
#include "stimulus/shapes.hpp"
#include "test/scene/shadow_checks.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A row of boxes over small plates of their own.
SceneFrame plates() {
  SceneFrame f;
  for (int i = 0; i < 12; ++i) {
    add_solid(f, box_solid(), {4.0 * i, 0, 0}, {1, 0.1, 1}, Turn{}, {1, 1, 1});
    add_solid(f, octahedron_solid(), {4.0 * i, 2, 0}, {0.5, 0.5, 0.5}, Turn{}, {1, 1, 1}, i % 2 == 0);
  }
  f.lights[0].direction = glm::normalize(glm::dvec3(0.2, -1, 0.1));
  return f;
}

std::size_t faces(const FrameGeometry& g) { return g.volume_faces.size(); }

}  // namespace

TEST_CASE("shadows left out change no pixel of random scenes") {
  Random random(test_seed());
  CAPTURE(test_seed());
  Look all;
  all.leave_out = false;
  std::size_t fewer = 0;
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    SceneFrame f = random_scene(random, random.in(1, 8), i % 2 == 0);
    f.camera.half_height *= random.chance(0.5) ? 0.2 : 1;  // narrow views leave more out
    Config c;
    c.dsf_bits = 1 + i % 3;
    const FrameGeometry with = make_geometry(f, c, kWidth, kHeight, {.look = all});
    const FrameGeometry without = make_geometry(f, c, kWidth, kHeight);
    fewer += faces(without) < faces(with) ? 1 : 0;
    CHECK(draw(with, c) == draw(without, c));
  }
  CAPTURE(fewer);
  CHECK(fewer > 30);
}

TEST_CASE("of a row of bodies those cast whose shadows may be seen") {
  for (const bool directional : {true, false})
    for (const int bits : {1, 4}) {
      CAPTURE(directional, bits);
      SceneFrame f = plates();
      f.lights[0].directional = directional;
      f.lights[0].position = {20, 30, 3};
      look_at(f.camera, {20, 4, 6}, {20, 0, 0});
      f.camera.half_height = 0.4;
      Config c;
      c.dsf_bits = bits;
      Look all;
      all.leave_out = false;
      const FrameGeometry with = make_geometry(f, c, kWidth, kHeight, {.look = all});
      const FrameGeometry without = make_geometry(f, c, kWidth, kHeight);
      CHECK(2 * faces(without) < faces(with));
      CHECK(faces(without) > 0);
      CHECK(draw(with, c) == draw(without, c));
      // Nothing seen, nothing cast.
      look_at(f.camera, {20, 4, 6}, {20, 9, 12});
      CHECK(make_geometry(f, c, kWidth, kHeight).volumes.empty());
      // Shadows that come from behind the eye are seen.
      look_at(f.camera, {20, 1, 0.9}, {20, 0, -0.5});
      CHECK(draw(make_geometry(f, c, kWidth, kHeight, {.look = all}), c) ==
            draw(make_geometry(f, c, kWidth, kHeight), c));
    }
}

}  // namespace kage::verif
