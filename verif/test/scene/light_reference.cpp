// SPDX-License-Identifier: Apache-2.0
// The reference of light is that of docs/lights.md: the closed form at points of a plane, the same by the tree of boxes
// as without it, grids over a window that converge. Where kage's approximation is exact, the golden core's picture is
// the reference's, and one with other light is not.
#include "oracle/light_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <stdexcept>

#include "kage/geometry.hpp"
#include "kage/light.hpp"
#include "oracle/judge.hpp"
#include "oracle/light_truth.hpp"
#include "stimulus/random.hpp"
#include "stimulus/scenes/lit_scenes.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::verif;

namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

LitScene scene_named(const std::string& name) {
  for (LitScene& s : lit_scenes())
    if (s.name == name) return s;
  throw std::runtime_error(name);
}

SceneFrame frame_of(const LitScene& s) { return Scene::from(s.parts).frame(0, 1); }
SceneFrame frame_named(const std::string& name) { return frame_of(scene_named(name)); }

LightReference<RayScene>::Points grid_points(const SceneFrame& f, int side) {
  LightReference<RayScene>::Points points;
  for (const Light& l : f.lights) points.push_back(reference_points(l, side, {0, 0, 0}));
  return points;
}

constexpr glm::dvec3 kBlockMiddle{1, 0.5, -0.4};  // the still life's block and ball
constexpr glm::dvec3 kBlockHalf{0.4, 0.5, 0.5};
constexpr glm::dvec3 kBallMiddle{-0.6, 0.7, 0.2};
constexpr double kBallRadius = 0.7;

/// The share of the way from a to b within the block, negated; by how much of the way it passes it by, if positive.
double outside_block(const glm::dvec3& a, const glm::dvec3& b) {
  double from = 0;
  double until = 1;
  for (int k = 0; k < 3; ++k) {
    const double d = b[k] - a[k];
    const double s = (kBlockMiddle[k] - kBlockHalf[k] - a[k]) / d;
    const double t = (kBlockMiddle[k] + kBlockHalf[k] - a[k]) / d;
    from = std::max(from, std::min(s, t));
    until = std::min(until, std::max(s, t));
  }
  return from - until;
}

/// How far from the ball's middle the way from a to b comes, in radii.
double from_ball(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = b - a;
  const double t = std::clamp(glm::dot(kBallMiddle - a, d) / glm::dot(d, d), 0.0, 1.0);
  return glm::distance(a + t * d, kBallMiddle) / kBallRadius;
}

/// The light's share that a place of the floor gets if nothing is in between.
using FloorLight = std::function<double(const glm::dvec3& at)>;

/// The reference's floor is that of a closed form, bodies' shadows too, but near the edges of shadows. `ends`: some of
/// it is beyond the light's cone or range.
void check_floor(Light light, const glm::dvec3& from, bool ends, const FloorLight& arrives) {
  LitScene scene = scene_named("two-triangles");
  scene.parts.lights = {{light}};
  const SceneFrame f = Scene::from(scene.parts).frame(0, 1);
  light = f.lights[0];  // scaled as the scene has it
  const RayScene rays(f);
  const LightReference reference(f, rays, grid_points(f, 1), kWidth, kHeight);
  int lit = 0;
  int dark = 0;
  int gone = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const ReferencePixel p = reference.pixel(x, y);
      if (p.face == kNothing || f.polygons[p.face].triangle > 1) continue;  // the floor's are the first two
      const PixelRay ray = pixel_ray(f.camera, x, y, kWidth, kHeight);
      const glm::dvec3 at = ray.origin - ray.direction * (ray.origin.y / ray.direction.y);
      const glm::dvec3 to = light.directional ? at - 100.0 * light.direction : from;
      const double block = outside_block(at, to);
      const double ball = from_ball(at, to);
      if (std::abs(block) < 0.02 || (ball > 0.95 && ball < 1.01)) continue;  // its faces lie within the ball
      const bool hidden = block < 0 || ball < 1;
      const double direct = hidden ? 0 : 0.8 * light.color.x * arrives(at);
      const double linear = std::min(0.95 * (0.2 + 0.04 * (1 + f.camera.up.y) + direct), 1.0);
      const double expected = 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055);
      CAPTURE(x, y, block, ball, p.shadowed);
      REQUIRE(std::abs(p.color.x - expected) < 1e-6);
      ++(hidden ? dark : direct > 0 ? lit : gone);
    }
  CHECK(lit > 500);
  CHECK(dark > 50);
  CHECK((gone > 500) == ends);
}

Light lamp_at(const glm::dvec3& position) {
  Light l;
  l.directional = false;
  l.position = position;
  l.falls_off = true;
  return l;
}

}  // namespace

TEST_CASE("the light of a floor is the closed form: lamp, sun, cone and range") {
  const glm::dvec3 place{-1.6, 1.7, 1.6};
  const auto lamp_form = [&](const glm::dvec3& at) {
    const double d2 = glm::dot(at - place, at - place);
    return place.y / (d2 * std::sqrt(d2));
  };
  check_floor(lamp_at(place), place, false, lamp_form);

  Light sun;
  sun.direction = glm::normalize(glm::dvec3(0.6, -0.8, -0.2));
  check_floor(sun, {}, false, [&](const glm::dvec3& /*at*/) { return 0.8 / std::sqrt(0.36 + 0.64 + 0.04); });

  Light ranged = lamp_at(place);
  ranged.range = 3;
  check_floor(ranged, place, true, [&](const glm::dvec3& at) {
    const double d2 = glm::dot(at - place, at - place);
    return d2 >= 9 ? 0 : lamp_form(at) * (1 - d2 * d2 / 81);
  });

  // Straight down: the angle's cosine is height over distance.
  Light cone = lamp_at({0.3, 3, 0.6});
  cone.spot = true;
  cone.direction = {0, -1, 0};
  cone.inner_cosine = std::cos(0.3);
  cone.outer_cosine = std::cos(0.7);
  check_floor(cone, cone.position, true, [&](const glm::dvec3& at) {
    const double d = glm::distance(at, cone.position);
    const double t = (3 / d - std::cos(0.7)) / (std::cos(0.3) - std::cos(0.7));
    return 3 / (d * d * d) * (t <= 0 ? 0 : t >= 1 ? 1 : t * t);
  });
}

TEST_CASE("rays by the tree meet what rays without it meet") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int i = 0; i < 40; ++i) {
    const SceneFrame f = random_scene(random, 12);
    const double scale = std::array{1.0, 0x1p-100, 0x1p60}[static_cast<std::size_t>(i % 3)];
    SceneFrame scaled = f;
    for (glm::dvec3& v : scaled.vertices) v *= scale;
    const RayScene rays(scaled);
    for (int k = 0; k < 100; ++k) {
      glm::dvec3 origin{random.real(-6, 6), random.real(-6, 6), random.real(-6, 6)};
      if (k % 4 == 1) {  // on a face, as the rays to lights are
        const Triangle& t =
            f.triangles[static_cast<std::size_t>(random.in(0, static_cast<int>(f.triangles.size()) - 1))];
        origin = (f.vertices[t.vertex[0]] + f.vertices[t.vertex[1]] + f.vertices[t.vertex[2]]) / 3.0;
      }
      glm::dvec3 direction = random_direction(random);
      if (k % 3 == 0) direction[k % 2] = 0;  // along a plane of boxes
      if (k % 9 == 0) direction[2] = 0;      // along an edge of them, or no way at all in one more
      if (direction == glm::dvec3(0)) direction.x = 1;
      origin *= scale, direction *= scale;
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

TEST_CASE("grids are even over disc, rectangle and the disc that a ball is seen as") {
  const glm::dvec3 from{3, -1, 2};
  for (const LightShape shape : {LightShape::disc, LightShape::rectangle, LightShape::sphere}) {
    Light l = lamp_at({0.5, 2, -1});
    l.shape = shape;
    l.axis_u = shape == LightShape::sphere ? glm::dvec3(0.7) : glm::dvec3(0.7, 0, 0);
    l.axis_v = {0, 0.3, 0.4};
    const glm::dvec3 to = glm::normalize(l.position - from);
    const std::vector<LightPoint> points = reference_points(l, 16, from);
    REQUIRE(points.size() == 256);
    glm::dvec3 mean{0, 0, 0};
    double u = 0;  // second moments, in half axes; of the ball along and across the way to it
    double v = 0;
    for (const LightPoint& p : points) {
      const glm::dvec3 off = p.position - l.position;
      mean += off / 256.0;
      const double along = glm::dot(off, to) / 0.7;
      u += (shape == LightShape::sphere ? along * along : std::pow(off.x / 0.7, 2)) / 256;
      v += (shape == LightShape::sphere ? glm::dot(off, off) / 0.49
                                        : glm::dot(off, l.axis_v) * glm::dot(off, l.axis_v) / 0.0625) /
           256;
    }
    CAPTURE(static_cast<int>(shape));
    CHECK(glm::length(mean) < 1e-12);
    // It is a quarter for a disc, a third for a square, less what a grid of 16 lacks, and a half in all for a ball.
    const double exact_u = shape == LightShape::disc ? 0.25 : shape == LightShape::rectangle ? (1 - 1.0 / 256) / 3 : 0;
    const double exact_v = shape == LightShape::sphere ? 0.5 : exact_u;
    CHECK(std::abs(u - exact_u) < 1e-12);
    CHECK(std::abs(v - exact_v) < 1e-12);
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
  const SceneFrame f = frame_named("sun-and-millionth");
  Config c = config_for_lights(f, Look{}.samples);
  c.smooth = 1;
  c.color_frac = 8;
  const RayScene rays(f);
  const auto picture =
      reference_picture(LightReference(f, rays, sampled_points(f, {}), kWidth, kHeight), kWidth, kHeight);
  const LightError e = compare_light(draw(make_geometry(f, c, kWidth, kHeight), c), picture);
  UNSCOPED_INFO(fmt::format("{} in shadow, mean {:.2f}, worst {:.2f}, others {:.2f}, {:.2f}; {:.1f} dB", e.shadowed,
                            e.mean(), e.worst, e.lit_mean(), e.lit_worst, e.psnr()));
  CHECK(e.shadowed > 700);
  CHECK(e.ties < e.pixels / 50);
  CHECK(e.mean() < 1);
  CHECK(e.worst < 12);  // at the ball's terminator, where light changes within a face; on the floor 1
  CHECK(e.lit_worst < 12);
  CHECK(e.lit_mean() < 1);  // colours of corners are rounded, those of pixels too, and a ball's faces are flat
}

// A window beside a table from wholly below its top to wholly above it. Points behind the top are in its own shadow:
// each pixel counts them, besides those of the others that rays find hidden.
TEST_CASE("a table shows the shadows of a window at every height, and nothing pops") {
  constexpr int kAcross = 80;
  constexpr int kDown = 60;
  std::uint64_t wrong = 0;
  std::uint64_t compared = 0;
  std::uint64_t shadowed = 0;
  double worst_mean = 0;
  double worst_change = 0;
  for (const int samples : {4, 15, 64}) {
    double before = -1;
    for (int step = 0; step <= 40; ++step) {
      if (samples == 64 && step % 4 != 0) continue;
      const double height = -1 + step * 0.075;
      CAPTURE(samples, height);
      const SceneFrame f = frame_of(table_and_window(height));
      Look look;
      look.samples = samples;
      Config c;
      c.class_bits = 4;
      c.smooth = 1;
      c.color_frac = 8;
      c = config_for_lights(f, samples, c);
      c.shade_frac = 16;
      const FrameGeometry g = make_geometry(f, c, kAcross, kDown, {.look = look});
      const std::vector<std::uint32_t> picture = draw(g, c);
      const auto counts = shadow_counts(g, c);
      const auto seen = seen_polygons(g, c);
      const auto points = sampled_points(f, look);
      const RayScene rays(f);
      const LightReference reference(f, rays, points, kAcross, kDown);
      double sum = 0;
      std::uint64_t pixels = 0;
      for (int y = 0; y < kDown; ++y)
        for (int x = 0; x < kAcross; ++x) {
          const std::size_t i = static_cast<std::size_t>(y) * kAcross + static_cast<std::size_t>(x);
          if (seen[i] == ~0U || !g.polygons[seen[i]].lit) continue;
          const ReferencePixel p = reference.pixel(x, y);
          if (p.face != g.polygons[seen[i]].source) continue;  // a tie
          const Triangle& t = f.triangles[f.polygons[p.face].triangle];
          const glm::dvec3 a = f.vertices[t.vertex[0]];
          const glm::dvec3 n = glm::cross(f.vertices[t.vertex[1]] - a, f.vertices[t.vertex[2]] - a);
          const double eye = glm::dot(n, f.camera.eye - a);
          // A point in the face's plane, to a millionth of the scene, gives it nothing, and its shadow may fall on it
          // or not: corners are snapped.
          const auto behind = [&](double more) {
            return std::count_if(points[0].begin(), points[0].end(), [&](const LightPoint& at) {
              return glm::dot(n, at.position - a) * (eye > 0 ? 1 : -1) < more * glm::length(n);
            });
          };
          const auto hidden = std::count(p.hidden.begin(), p.hidden.end(), true);
          const auto count = static_cast<std::ptrdiff_t>(counts[i][0]);
          const bool right = count >= hidden + behind(-2e-6) && count <= hidden + behind(2e-6);
          ++compared;
          shadowed += p.shadowed ? 1U : 0U;
          if (!right && !reference.pixel_with_ties(x, y, 1.0 / 128).tie) ++wrong;
          if (t.object > 0 || !p.shadowed) continue;
          sum += std::abs((picture[i] & 255U) - p.color.x);
          ++pixels;
        }
      if (pixels > 0) worst_mean = std::max(worst_mean, sum / static_cast<double>(pixels));
      // Nothing pops: from height to height the mean of the picture moves as that of the truth does.
      double shown = 0;
      double truth = 0;
      for (int y = 0; y < kDown; y += 3)
        for (int x = 0; x < kAcross; x += 3) {
          const std::size_t i = static_cast<std::size_t>(y) * kAcross + static_cast<std::size_t>(x);
          const ReferencePixel p = reference.pixel(x, y);
          if (p.face == kNothing || seen[i] == ~0U) continue;
          shown += picture[i] & 255U;
          truth += p.color.x;
        }
      const double off = (shown - truth) / (kAcross * kDown / 9.0);
      if (before > -1) worst_change = std::max(worst_change, std::abs(off - before));
      before = off;
    }
  }
  std::printf(
      "table and window: %llu of %llu pixels have another count, %llu in shadow; mean error %.2f at most, "
      "%.2f more or less from height to height\n",
      static_cast<unsigned long long>(wrong), static_cast<unsigned long long>(compared),
      static_cast<unsigned long long>(shadowed), worst_mean, worst_change);
  CHECK(wrong == 0);
  CHECK(worst_mean < 4);  // 15 classes, and no more than 255 before a face's own shadow
  CHECK(worst_change < 1);
  CHECK(compared > 100000);
  CHECK(shadowed > 30000);
}

TEST_CASE("the reference tells light that is wrong") {
  const SceneFrame f = frame_named("sun");
  Config c;
  c.smooth = 1;
  c.color_frac = 8;
  const RayScene rays(f);
  const auto picture =
      reference_picture(LightReference(f, rays, sampled_points(f, {}), kWidth, kHeight), kWidth, kHeight);
  FrameGeometry g = make_geometry(f, c, kWidth, kHeight);
  const LightError before = compare_light(draw(g, c), picture);
  CHECK(before.mean() < 4);  // one share for a floor and a ball
  g.shade = g.shade * 9 / 10;
  const LightError lighter = compare_light(draw(g, c), picture);
  CHECK(lighter.mean() > before.mean() + 5);
  CHECK(lighter.lit_sum == before.lit_sum);
  for (ScreenPolygon& p : g.polygons)
    p.color[0] = static_cast<std::uint8_t>(p.color[0] - std::min<int>(p.color[0], 20));
  CHECK(compare_light(draw(g, c), picture).lit_mean() > before.lit_mean() + 5);
}
