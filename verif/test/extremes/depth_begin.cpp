// SPDX-License-Identifier: Apache-2.0
// Families 15, 18, 21, 24, 26, 27 where the near plane is far nearer than anything seen, and from far away through a
// long lens: depth begins at what is seen.
#include <cmath>

#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/scene/shadow_checks.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 72;

/// Boxes and octahedra on a floor round the origin, some of them in others, 10 across.
SceneFrame town() {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -2.2, 0}, {5, 0.2, 5}, Turn{}, {1, 1, 1});
  for (int i = 0; i < 12; ++i) {
    const double x = -3.3 + 2.2 * (i % 4);
    const double z = -2.2 + 2.2 * std::floor(i / 4.0);
    add_solid(f, box_solid(), {x, -1.5, z}, {0.4, 0.5 + 0.1 * i, 0.5}, Turn{}, {1, 1, 1});
    add_solid(f, octahedron_solid(), {x + 0.3, -1 + 0.1 * i, z + 0.2}, {0.6, 0.6, 0.6}, Turn{}, {1, 1, 1});
  }
  f.lights[0].direction = glm::normalize(glm::dvec3(0.4, -1, 0.3));
  return f;
}

/// `f` seen from a thousand times as far, through a lens as much longer, with the near plane 0.1 before the eye.
void telephoto(SceneFrame& f) {
  const glm::dvec3 target = f.camera.eye + f.camera.forward * 7.0;
  f.camera.eye = target - f.camera.forward * 7000.0;
  if (f.camera.perspective) f.camera.half_height /= 1000;
  f.camera.near = 0.1;
}

/// How the camera sees: from where it is with a near plane close by, or from far away.
enum class Lens : std::uint8_t { close_plane, far_away };

void set(SceneFrame& f, Lens lens) {
  if (lens == Lens::far_away)
    telephoto(f);
  else
    f.camera.near = 1e-6;
}

constexpr std::array<Lens, 2> kLenses{Lens::close_plane, Lens::far_away};

std::uint64_t unlike(const RayCount& c) { return c.near_surface + c.near_shadow + c.wrong_surface + c.wrong_shadow; }

FrameGeometry geometry(const SceneFrame& f, const Config& config = {}, const Look& look = {}) {
  return make_geometry(f, config, kWidth, kHeight, {.look = look});
}

}  // namespace

TEST_CASE("a near plane far nearer than the scene, or a long lens, leaves surfaces and shadows right") {
  constexpr int kW = 320;
  constexpr int kH = 240;
  struct View {
    const char* name;
    double near;
    bool far_away;
    bool perspective;
    std::uint64_t least_before;  // pixels that depth from the near plane gets wrong, at least
  };
  for (const View& v : {View{"near plane at 1e-5", 1e-5, false, true, 100}, View{"at 1e-6", 1e-6, false, true, 1000},
                        View{"at 1e-9", 1e-9, false, true, 5000}, View{"from 7000 away", 0.1, true, true, 10000},
                        View{"parallel, from 7000 away", 0.1, true, false, 0}}) {
    SceneFrame f = town();
    look_at(f.camera, {3, 4, 9}, {0, -1, 0});
    f.camera.half_height = 0.4;
    f.camera.perspective = v.perspective;
    if (!v.perspective) f.camera.half_height = 4;
    if (v.far_away) telephoto(f);
    f.camera.near = v.near;
    Config config;
    Look from_near;
    from_near.depth_from_near = true;
    const RayCount now = compare_with_rays(f, make_geometry(f, config, kW, kH), config);
    const RayCount before = compare_with_rays(f, make_geometry(f, config, kW, kH, {.look = from_near}), config);
    UNSCOPED_INFO(v.name << ": " << now.text() << "; depth from the near plane: " << before.text());
    CAPTURE(v.name);
    CHECK(now.good());
    CHECK(now.shadowed > 1000);
    CHECK(now.lit > 10000);
    CHECK(unlike(now) * 1000 < now.pixels);
    CHECK(unlike(before) >= v.least_before);
  }
}

TEST_CASE("family 15: with depth from w0 no face and no volume leaves the range of depth before its far end") {
  Random random(test_seed(11));
  CAPTURE(test_seed(11));
  std::uint64_t looked = 0;
  for (int i = 0; i < 60; ++i)
    for (const Lens lens : kLenses) {
      SceneFrame f = random_scene(random, random.in(1, 6), i % 2 == 0);
      set(f, lens);
      const Config config;
      const FrameGeometry g = geometry(f, config);
      const double most = std::ldexp(1.0, config.z_bits) - 2;
      for (const ScreenPolygon& p : g.polygons) {
        const bool drawn = p.source != ~0U;
        for (int y = 0; y < kHeight; y += 5)
          for (int x = 0; x < kWidth; x += 5) {
            if (Oracle::winding(g.outline(p), x, y) == 0) continue;
            ++looked;
            const auto part = [](std::int64_t v, int n) { return static_cast<double>(v) * n; };
            const double z =
                (static_cast<double>(p.depth.c) + part(p.depth.a, x - p.depth.x0) + part(p.depth.b, y - p.depth.y0)) /
                (1 << kPlaneFrac);
            // Half a subpixel of snap each way, and a step.
            const double slack =
                1 + static_cast<double>(std::abs(p.depth.a) + std::abs(p.depth.b)) / (512.0 * (1 << kPlaneFrac));
            if (z < 1 - slack || (drawn && z > most + slack)) {
              CAPTURE(i, x, y, z, slack, drawn);
              FAIL("outside the range of depth");
            }
          }
      }
    }
  CHECK(looked > 10000);
}

TEST_CASE("family 18: panes a few steps apart keep their order, however near the near plane") {
  for (const Lens lens : kLenses)
    for (const bool perspective : {true, false}) {
      SceneFrame f;
      // The nearest first, so that a tie would show a further one... of equal depths the first drawn stays.
      constexpr int kPanes = 16;
      const double apart = lens == Lens::far_away && perspective ? 0.05 : 1e-4;
      for (int i = kPanes - 1; i >= 0; --i)
        add_solid(f, pane_solid(), {-2.5 + 0.3 * i, 0.2 * (i % 3), -apart * i}, {1, 1, 1}, Turn{}, {1, 1, 1}, false,
                  false);
      look_at(f.camera, {0, 0, 7}, {0, 0, 0});
      f.camera.perspective = perspective;
      f.camera.half_height = perspective ? 0.4 : 2.8;
      set(f, lens);
      Config config;
      config.dsf_bits = 0;
      const FrameGeometry g = geometry(f, config);
      const RayPictures p = ray_pictures(g, config);
      const RayScene rays(f);
      std::uint64_t wrong = 0;
      std::uint64_t covered = 0;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          const PixelRay ray = pixel_ray(f.camera, x, y, kWidth, kHeight);
          const std::uint32_t seen = p.seen[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
          const std::uint32_t face = seen == kNothing ? kNothing : g.polygons[seen].source;
          const std::uint32_t truth = rays.nearest(ray.origin, ray.direction, f.camera.near).second;
          covered += truth == kNothing ? 0 : 1;
          if (face != truth && !near_volume_edge(g, x, y, 1)) ++wrong;
        }
      CAPTURE(lens, perspective, covered);
      CHECK(covered > 1000);
      CHECK(wrong == 0);
    }
}

TEST_CASE("family 21: random scenes with a near plane at 1e-6, and from 7000 away, are what rays say") {
  Random random(test_seed(12));
  CAPTURE(test_seed(12));
  for (const Lens lens : kLenses)
    rays_agree(60, [&](int i) {
      CAPTURE(lens);
      SceneFrame f = random_scene(random, random.in(1, 6), i % 2 == 0);
      set(f, lens);
      const Config config = counting(i % 3 == 2 ? 3 : 1);
      judge_all(f, config, kWidth, kHeight);
      sums_are_zero(f, config, kWidth, kHeight);
      return compare_with_rays(f, kWidth, kHeight, 1, config);
    });
}

TEST_CASE("family 24: the eye in, out and on shadow planes with a near plane at 1e-6") {
  Random random(test_seed(13));
  CAPTURE(test_seed(13));
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 2, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0.5, 3.2, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1}, false, false);
  add_solid(f, octahedron_solid(), {2.5, 1, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  f.lights[0].direction = {0, -1, 0};  // shadow planes of the box: x = +-1, z = +-1
  RayCount count;
  std::size_t inside = 0;
  for (const double x : {std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0), 0.0, 1.7, -1.0})
    for (const double z : {-1.0, std::nextafter(-1.0, 0.0), 0.3, 1.0}) {
      CAPTURE(x, z);
      look_at(f.camera, {x, -0.5, z}, {random.real(-4, 4), random.real(-3, 0), random.real(-4, 4)});
      f.camera.near = 1e-6;
      for (const int bits : {1, 3}) {
        const Config config = counting(bits);
        judge_all(f, config, kWidth, kHeight);
        sums_are_zero(f, config, kWidth, kHeight);
        const RayCount here = compare_with_rays(f, kWidth, kHeight, 1, config);
        INFO(here.text());
        CHECK(here.good());
        count += here;
        inside += geometry(f, config).near_edges.size();
      }
    }
  CHECK(inside > 50);
  rays_decided(count);
}

TEST_CASE("family 24: a caster between the near plane and w0, beside the picture, casts into it") {
  // A post close to the eye, right of the view, and the sun behind it: its shadow falls across the floor ahead.
  SceneFrame f;
  add_solid(f, box_solid(), {0, -2, -20}, {20, 0.5, 20}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {1.2, 0, -0.2}, {0.3, 1.4, 0.1}, Turn{}, {1, 1, 1});
  look_at(f.camera, {0, 0, 0}, {0, -0.35, -1});
  f.camera.half_height = 0.3;
  f.camera.near = 1e-6;
  f.lights[0].direction = glm::normalize(glm::dvec3(-0.5, -0.45, -1));
  const FrameGeometry g = geometry(f);
  const RayCount count = compare_with_rays(f, g, Config{});
  INFO(count.text());
  CHECK(count.good());
  CHECK(count.shadowed > 200);
  // It lies before w0 and is cut away whole; the caps that are left are sides and the section with w0.
  CHECK(g.span_reasons[1] == SpanReason::cut);
  CHECK(!g.near_edges.empty());
  judge_all(f, {}, kWidth, kHeight);
  sums_are_zero(f, {}, kWidth, kHeight);
}

TEST_CASE("family 26: volumes that reach further give the same picture with a near plane at 1e-6 and from far away") {
  Random random(test_seed(14));
  CAPTURE(test_seed(14));
  std::size_t different = 0;
  std::size_t pixels = 0;
  for (const Lens lens : kLenses)
    for (int i = 0; i < 30; ++i) {
      CAPTURE(lens, i);
      SceneFrame f = random_scene(random, 5);
      set(f, lens);
      Look further;
      further.extrusion = 3;
      different += same_but_near_ties(geometry(f), Config{}, geometry(f, {}, further), Config{});
      pixels += std::size_t{kWidth} * kHeight;
    }
  CAPTURE(different);
  CHECK(different * 1000 < pixels);
}

TEST_CASE("family 27: a cap has no acne with a near plane at 1e-6 and from far away") {
  Random random(test_seed(15));
  CAPTURE(test_seed(15));
  for (const Lens lens : kLenses)
    for (int i = 0; i < 60; ++i) {
      CAPTURE(lens, i);
      SceneFrame f;
      add_solid(f, i % 2 == 0 ? octahedron_solid() : box_solid(), {0, 0, 0}, {1, 1, 1}, random_turn(random), {1, 1, 1});
      look_at(f.camera, {0, 0, 7}, {0, 0, 0});
      f.camera.half_height = 0.25;
      set(f, lens);
      f.lights[0].direction = random_direction(random);
      const FrameGeometry g = geometry(f);
      Oracle oracle(g, Config{});
      std::uint64_t lit_and_shadowed = 0;
      for (int y = 0; y < kHeight; ++y) {
        oracle.line(y);
        for (int x = 0; x < kWidth; ++x) {
          const OraclePixel p = oracle.at(x);
          if (p.shadowed && g.polygons[static_cast<std::uint32_t>(p.surface)].lit && !near_volume_edge(g, x, y, 1.5))
            ++lit_and_shadowed;
        }
      }
      CHECK(lit_and_shadowed == 0);
      judge_all(f, {}, kWidth, kHeight);
    }
}

}  // namespace kage::verif
