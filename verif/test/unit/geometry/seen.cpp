// SPDX-License-Identifier: Apache-2.0
// Where depth begins: w0, from what the picture shows.
#include "geometry/seen.hpp"

#include <cmath>

#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

/// A wall across the view, `distance` before an eye at the origin.
SceneFrame wall(double distance, bool perspective = true) {
  SceneFrame f;
  add_solid(f, pane_solid(), {0, 0, -distance}, {distance, distance, 1}, Turn{}, {1, 1, 1}, false, false);
  look_at(f.camera, {0, 0, 0}, {0, 0, -1});
  f.camera.half_height = perspective ? 0.4 : 0.4 * distance;
  f.camera.perspective = perspective;
  f.camera.near = 1e-6;
  return f;
}

void add_box(SceneFrame& f, const glm::dvec3& at, double size = 0.01, std::uint8_t alpha = 255) {
  add_solid(f, box_solid(), at, glm::dvec3(size), Turn{}, {1, 1, 1}, true, true, alpha);
}

DepthRange range(const SceneFrame& f, const Config& config = {}, const Look& look = {}) {
  return depth_range(f, config, kWidth, kHeight, look, eye_points(f));
}

double w0(const SceneFrame& f, const Config& config = {}, const Look& look = {}) { return range(f, config, look).near; }

}  // namespace

TEST_CASE("depth begins at the power of two below the nearest surface in the picture, not before the near plane") {
  CHECK(w0(wall(7)) == 4);
  CHECK(w0(wall(8.1)) == 8);
  CHECK(w0(wall(8)) == 4);  // nothing is cut by a rounding: what lies at a power of two is taken to lie before it
  CHECK(w0(wall(8 * (1 + 0x1p-19))) == 8);
  CHECK(w0(wall(0.3)) == 0.25);
  SceneFrame f = wall(7);
  f.camera.near = 5;
  CHECK(w0(f) == 5);
  f.camera.near = 1e-6;
  add_box(f, {0, 5, -1.5});  // above the picture: its upper edge is 0.6 high there
  add_box(f, {0, 0, 3});     // behind the eye
  CHECK(w0(f) == 4);
  add_box(f, {0, 0, -1.5});
  CHECK(w0(f) == 1);
  Look look;
  look.depth_from_near = true;
  CHECK(w0(f, {}, look) == 1e-6);
  f.camera.near = 1.2;
  CHECK(w0(f) == 1.2);
}

TEST_CASE("a face counts from where it comes into the picture") {
  // The floor is 1 below the eye, and the picture's lower edge meets it 1 / 0.4 away.
  SceneFrame f = wall(7);
  add_solid(f, pane_solid(), {0, -1, 0}, {100, 100, 1}, Turn{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {1, 1, 1}, false,
            false);
  CHECK(w0(f) == 2);
  // The guard band is no edge of the picture: a wall beside it, nearer than anything in it.
  f = wall(7);
  add_solid(f, box_solid(), {2, 0, -1}, {0.1, 0.1, 0.1}, Turn{}, {1, 1, 1});
  CHECK(w0(f) == 4);
}

TEST_CASE("faces that are not drawn do not count") {
  SceneFrame f = wall(7);
  const auto first = static_cast<std::uint32_t>(f.triangles.size());
  add_box(f, {0, 0, -1.5}, 0.01, 0);
  Config glass;
  glass.translucency = 1;
  CHECK(w0(f, glass) == 4);
  CHECK(w0(f) == 1);  // without blending it is drawn, opaque
  for (std::uint32_t i = first; i < f.triangles.size(); ++i) f.triangles[i].alpha = 128;
  CHECK(w0(f, glass) == 1);
  // A pane of glass that the eye sees exactly edge-on covers nothing.
  f = wall(7);
  add_solid(f, pane_solid(), {0, 0, -3}, {1, 1, 1}, Turn{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}, {1, 1, 1}, false, false,
            100);
  CHECK(w0(f, glass) == 4);
  f.camera.eye.x = 0.01;
  CHECK(w0(f, glass) == 1);
  // Culled from behind, drawn from before.
  for (const Sides sides : {Sides::front, Sides::back}) {
    f = wall(7);
    add_solid(f, pane_solid(), {0, 0, -3}, {0.1, 0.1, 1}, Turn{}, {1, 1, 1}, false, false);
    for (Triangle& t : f.triangles) t.sides = sides;
    for (std::size_t i = 0; i < 2; ++i) f.triangles[i].sides = Sides::both;
    Look look;
    look.cull = true;
    CHECK(w0(f, {}, look) == (sides == Sides::front ? 2 : 4));
    CHECK(w0(f) == 2);
  }
}

TEST_CASE("a picture of nothing keeps the near plane, whatever lies outside it") {
  SceneFrame f = wall(7);
  f.camera.forward = {0, 0, 1};
  f.camera.right = {-1, 0, 0};
  DepthRange r = range(f);
  CHECK(r.near == 1e-6);
  CHECK(r.far > r.near);
  add_box(f, {0, 50, 5});  // ahead, but above the picture
  r = range(f);
  CHECK(r.near == 1e-6);
  CHECK(r.far > 5);
  (void)make_geometry(f, Config{}, kWidth, kHeight);
}

TEST_CASE("in parallel view depth begins at a multiple of the power of two below the depth of what there is") {
  // One wall: its depth is the millionth by which the far end lies past it.
  SceneFrame f = wall(7, false);
  DepthRange r = range(f);
  CHECK(r.near < 7);
  CHECK(r.far > 7);
  CHECK(r.far - r.near < 2 * (r.far - 7) * 1.001);
  // From 1000 to 1009, 9 deep: multiples of 8.
  f = wall(1009, false);
  add_box(f, {0, 0, -1000.5}, 0.5);
  CHECK(w0(f) == 1000 - 8);  // 1000 itself is taken to lie before it
  add_box(f, {0, 0, -1004}, 3.9);
  CHECK(w0(f) == 1000 - 8);
  f.camera.near = 995;
  CHECK(w0(f) == 995);
  f = wall(1009, false);
  add_box(f, {0, 0, -1001.5}, 0.5);
  CHECK(w0(f) == 1000);
  add_box(f, {0, 600, -10});  // above the picture
  CHECK(w0(f) == 1000);
  // A scene that begins at the camera: no multiple is above 0 but the near plane is.
  add_box(f, {0, 0, -3});
  CHECK(w0(f) == 1e-6);
}

TEST_CASE("no ray meets a face before w0, and w0 costs at most a bit") {
  Random random(test_seed());
  CAPTURE(test_seed());
  int moved = 0;
  int tight = 0;
  for (int i = 0; i < 200; ++i) {
    SceneFrame f = random_scene(random, random.in(1, 8));
    f.camera.near = std::ldexp(1.0, -random.in(3, 24));
    const DepthRange r = range(f);
    CAPTURE(i, r.near, r.far);
    CHECK(r.near >= f.camera.near);
    CHECK(r.far > r.near);
    const RayScene rays(f);
    double least = INFINITY;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const PixelRay ray = pixel_ray(f.camera, x, y, kWidth, kHeight);
        least = std::min(least, rays.nearest(ray.origin, ray.direction, f.camera.near).first);
      }
    CHECK(r.near <= least);
    moved += r.near > f.camera.near ? 1 : 0;
    if (r.near == f.camera.near || std::isinf(least)) continue;
    // The rays through pixels' middles may miss what is nearest, so their least is no less than the true one.
    const double cost = f.camera.perspective ? least / r.near : (r.far - r.near) / (r.far - least);
    tight += cost <= 2.001 ? 1 : 0;
  }
  CAPTURE(moved, tight);
  CHECK(moved > 100);
  CHECK(tight * 10 > moved * 9);
}

}  // namespace kage::verif
