// SPDX-License-Identifier: Apache-2.0
// The reference of light is that of docs/lights.md: the closed form at points of a plane, the same by the tree of boxes
// as without it, grids over a window that converge. Where kage's approximation is exact, the golden core's picture is
// the reference's, and one with other light is not.
#include "oracle/light_reference.hpp"

#include <fmt/format.h>

#include "kage/geometry.hpp"
#include "kage/light.hpp"
#include "oracle/judge.hpp"
#include "oracle/light_truth.hpp"
#include "stimulus/lit_scenes.hpp"
#include "stimulus/random.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::verif;

namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

SceneFrame frame_of(const LitScene& s) { return Scene::from(s.parts).frame(0, 1); }

SceneFrame frame_named(const std::string& name) {
  for (const LitScene& s : lit_scenes())
    if (s.name == name) return frame_of(s);
  throw std::runtime_error(name);
}

/// The points that kage casts shadows from.
LightReference<RayScene>::Points kage_points(const SceneFrame& f, int samples) {
  LightReference<RayScene>::Points points;
  const Look look;
  for (std::size_t l = 0; l < f.lights.size(); ++l) points.push_back(light_points(f.lights[l], samples, look.seed + l));
  return points;
}

LightReference<RayScene>::Points grid_points(const SceneFrame& f, int side) {
  LightReference<RayScene>::Points points;
  for (const Light& l : f.lights) points.push_back(reference_points(l, side, {0, 0, 0}));
  return points;
}

LightError error_of(const SceneFrame& f, const Config& config) {
  const RayScene rays(f);
  const LightReference reference(f, rays, kage_points(f, Look{}.samples), kWidth, kHeight);
  return compare_light(draw(make_geometry(f, config, kWidth, kHeight), config), kWidth, kHeight, reference);
}

}  // namespace

TEST_CASE("a lamp over a floor is the closed form at every pixel of the floor") {
  SceneFrame f = frame_named("two-triangles");
  const Light& lamp = f.lights[0];
  const RayScene rays(f);
  const LightReference reference(f, rays, grid_points(f, 1), kWidth, kHeight);
  int lit = 0;
  int dark = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const ReferencePixel p = reference.pixel(x, y);
      if (p.face == kNothing || f.polygons[p.face].triangle > 1) continue;  // the floor's are the first two
      const PixelRay ray = pixel_ray(f.camera, x, y, kWidth, kHeight);
      const glm::dvec3 at = ray.origin - ray.direction * (ray.origin.y / ray.direction.y);
      const double h = lamp.position.y;
      const double d2 = (at.x - lamp.position.x) * (at.x - lamp.position.x) + h * h +
                        (at.z - lamp.position.z) * (at.z - lamp.position.z);
      const double ambient = 0.2 + 0.04 * (1 + f.camera.up.y);
      const double light = 0.95 * (ambient + (p.shadowed ? 0 : 0.8 * lamp.color.x * h / (d2 * std::sqrt(d2))));
      const double linear = std::min(light, 1.0);
      const double expected = 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055);
      REQUIRE(std::abs(p.color.x - expected) < 1e-6);
      ++(p.shadowed ? dark : lit);
    }
  CHECK(lit > 5000);
  CHECK(dark > 500);
}

TEST_CASE("rays by the tree meet what rays without it meet") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int i = 0; i < 40; ++i) {
    const SceneFrame f = random_scene(random, 12);
    const RayScene rays(f);
    for (int k = 0; k < 100; ++k) {
      const glm::dvec3 origin{random.real(-6, 6), random.real(-6, 6), random.real(-6, 6)};
      glm::dvec3 direction = random_direction(random);
      if (k % 3 == 0) direction[k % 2] = 0;  // along a plane of boxes
      std::vector<std::pair<double, std::uint32_t>> by_tree;
      std::vector<std::pair<double, std::uint32_t>> by_each;
      rays.meet(origin, direction, [&](double t, std::uint32_t face) { by_tree.emplace_back(t, face); });
      rays.meet_each(origin, direction, [&](double t, std::uint32_t face) { by_each.emplace_back(t, face); });
      std::sort(by_tree.begin(), by_tree.end());
      std::sort(by_each.begin(), by_each.end());
      REQUIRE(by_tree == by_each);
    }
  }
}

TEST_CASE("finer grids over a window come to the same light") {
  const SceneFrame f = frame_of(table_and_window(0.5));
  const RayScene rays(f);
  const LightReference coarse(f, rays, grid_points(f, 24), kWidth, kHeight);
  const LightReference fine(f, rays, grid_points(f, 48), kWidth, kHeight);
  double worst = 0;
  std::uint64_t shadowed = 0;
  for (int y = 0; y < kHeight; y += 4)
    for (int x = 0; x < kWidth; x += 4) {
      const ReferencePixel a = coarse.pixel(x, y);
      const ReferencePixel b = fine.pixel(x, y);
      REQUIRE(a.face == b.face);
      shadowed += b.shadowed ? 1U : 0U;
      for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(a.color[k] - b.color[k]));
    }
  UNSCOPED_INFO(fmt::format("{} pixels in shadow, worst {:.2f}", shadowed, worst));
  CHECK(shadowed > 200);
  CHECK(worst < 3);  // a row of the coarse grid is 1/24 of the light; where the table cuts it, half of one may be off
}

TEST_CASE("a sun's shadow is the reference's where its share comes from a table") {
  Config c = config_for_lights(frame_named("sun-and-millionth"), 15);
  c.smooth = 1;
  c.color_frac = 8;
  const LightError e = error_of(frame_named("sun-and-millionth"), c);
  UNSCOPED_INFO(fmt::format("{} in shadow, mean {:.2f}, worst {:.2f}, others {:.2f}, {:.2f}; {:.1f} dB", e.shadowed,
                            e.mean(), e.worst, e.lit_mean(), e.lit_worst, e.psnr()));
  CHECK(e.shadowed > 700);
  CHECK(e.ties < 1000);
  CHECK(e.mean() < 1);
  CHECK(e.lit_mean() < 1);  // colours of corners are rounded, those of pixels too, and a ball's faces are flat
}

TEST_CASE("the reference tells light that is wrong") {
  const SceneFrame f = frame_named("sun");
  Config c;
  c.smooth = 1;
  c.color_frac = 8;
  const RayScene rays(f);
  const LightReference reference(f, rays, kage_points(f, 1), kWidth, kHeight);
  FrameGeometry g = make_geometry(f, c, kWidth, kHeight);
  const double share = g.shade;
  const double before = compare_light(draw(g, c), kWidth, kHeight, reference).mean();
  g.shade = static_cast<std::uint32_t>(share * 0.9);
  const LightError lighter = compare_light(draw(g, c), kWidth, kHeight, reference);
  CHECK(std::abs(lighter.mean() - before) > 5);  // a tenth of the share, of colours of some 230
  for (ScreenPolygon& p : g.polygons)
    p.color[0] = static_cast<std::uint8_t>(p.color[0] - std::min<int>(p.color[0], 20));
  CHECK(compare_light(draw(g, c), kWidth, kHeight, reference).lit_worst > 15);
}
