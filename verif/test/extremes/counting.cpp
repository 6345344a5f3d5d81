// SPDX-License-Identifier: Apache-2.0
// Families 21 - 28 with DSF_BITS > 1: casters of any shape as volumes that count.
#include <cmath>

#include "extremes/shadows.hpp"
#include "kage/error.hpp"
#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/scene/shadow_checks.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;

std::size_t volumes(const SceneFrame& f, const Config& config) {
  return make_geometry(f, config, kWidth, kHeight).volumes.size();
}

void check(const SceneFrame& f, const Config& config) {
  judge_all(f, config, kWidth, kHeight);
  sums_are_zero(f, config, kWidth, kHeight);
}

/// Open, inverted and torn casters, over a floor that is a caster too.
SceneFrame torn_scene(Random& random) { return draw_case<TornCase>(random).frame(); }

}  // namespace

TEST_CASE("family 21: counting volumes are closed, and their pictures the oracle's") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int i = 0; i < 56; ++i) {
    const Config config = counting(2 + i % 7);
    CAPTURE(i, config.dsf_bits);
    check(i % 2 == 0 ? random_scene(random, random.in(1, 8), i % 4 == 0) : torn_scene(random), config);
  }
}

TEST_CASE("family 21: counting gives the shadow that a ray to the light says") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  rays_agree(56, [&](int i) {
    return compare_with_rays(random_scene(random, random.in(1, 8), i % 2 == 0), kWidth, kHeight, 1,
                             counting(2 + i % 7));
  });
}

TEST_CASE("family 22: one counting volume of nested, overlapping, touching casters gives what one for each gives") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  for (int k = 0; k <= 64; ++k) {
    std::vector<int> order(static_cast<std::size_t>(k));
    for (int i = 0; i < k; ++i) order[static_cast<std::size_t>(i)] = i;
    random.shuffle(order);
    const SceneFrame f = box_threes(order, 0.5);
    const FrameGeometry parity = make_geometry(f, Config{}, kWidth, kHeight);
    for (const int bits : {2, 4, 8}) {
      CAPTURE(k, bits);
      const FrameGeometry g = make_geometry(f, counting(bits), kWidth, kHeight);
      // Never more than box in box in box over the floor, and touching ones beside them.
      if (bits >= 4) CHECK(g.volumes.size() == 1);
      same_but_near_ties(parity, Config{}, g, counting(bits));
      judge_all(f, counting(bits), kWidth, kHeight);
    }
  }
}

TEST_CASE("family 23: a caster crossed 2, 3, 7, 2^b - 1 and 2^b times is right, and parted past the limit") {
  for (int bits = 1; bits <= 8; ++bits)
    for (const int n : {1, 2, 3, 7, (1 << bits) - 1, 1 << bits, (1 << bits) + 1}) {
      if (n > 130 && bits != 8) continue;
      CAPTURE(bits, n);
      const SceneFrame f = zigzag_scene(n);
      const Config config = counting(bits);
      judge_all(f, config, kWidth, kHeight);
      // The zigzag and the floor below it. They are one volume if they fit in one.
      if (bits > 1) CHECK((volumes(f, config) == 1) == (n + 1 <= (1 << bits) - 1));
      const RayCount count = compare_with_rays(f, kWidth, kHeight, 2, config);
      INFO(count.text());
      CHECK(count.good());
      CHECK(count.shadowed > 20);
      Config no_fsf = config;
      no_fsf.fsf = 0;
      std::vector<std::uint32_t> words;
      const FrameGeometry g = make_geometry(f, no_fsf, kWidth, kHeight);
      if (g.volumes.size() == 1)
        judge_all(f, no_fsf, kWidth, kHeight);
      else
        CHECK_THROWS_AS(make_frame(g, no_fsf, 0, words), Error);
    }
}

TEST_CASE("family 24: counting with the eye in, out and on shadow planes, near planes that cut volumes") {
  Random random(test_seed(5));
  CAPTURE(test_seed(5));
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 2, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1}, false, true);
  add_solid(f, box_solid(), {0.5, 3.2, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1}, false, false);
  add_solid(f, octahedron_solid(), {2.5, 1, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  f.lights[0].direction = {0, -1, 0};  // shadow planes of the box: x = +-1, z = +-1
  for (const double near : {0.01, 0.5, 2.0})
    for (const double x : {std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0), 0.0, 1.7, -1.0})
      for (const double z : {-1.0, std::nextafter(-1.0, 0.0), 0.3}) {
        CAPTURE(near, x, z);
        look_at(f.camera, {x, -0.5, z}, {random.real(-4, 4), random.real(-3, 0), random.real(-4, 4)});
        f.camera.near = near;
        for (const int bits : {2, 3, 8}) check(f, counting(bits));
      }
}

TEST_CASE("family 24: where the eye is in several shadows, IF has their number") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {20, 0.5, 20}, Turn{}, {1, 1, 1});
  for (int i = 0; i < 3; ++i) add_solid(f, box_solid(), {0, 2 + 2.0 * i, 0}, {3, 0.5, 3}, Turn{}, {1, 1, 1});
  f.lights[0].direction = {0, -1, 0};
  f.camera.near = 0.01;
  look_at(f.camera, {0, 0, 0}, {0, -0.5, 1});
  const Config config = counting(3);
  std::vector<std::uint32_t> words;
  Look look;
  look.leave_out = false;  // they fall behind the eye
  make_frame(make_geometry(f, config, kWidth, kHeight, {.look = look}), config, 0, words,
             {.threads = 1, .all_spans = true});
  const Layout layout(config);
  int inside = 0;
  TokenWalk walk(layout, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next()) {
    const Token t = decode(config, layout, token);
    if (t.kind != Kind::IF) continue;
    CHECK(std::abs(t.span.w) == 3);
    ++inside;
  }
  CHECK(inside == kHeight);
}

TEST_CASE("family 25: counting with the light on a face's plane, at a vertex, in a caster, behind the eye, far away") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  add_solid(f, octahedron_solid(), {1.5, 0.5, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  look_at(f.camera, {4, 3, 5}, {0, -1, 0});
  f.lights[0].directional = false;
  for (const double y : {1.0, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0), 1.0 + 1e-7, 0.0, 5.0, 1e6})
    for (const double x : {0.0, 1.0, 3.0, 30.0})
      for (const double z : {0.25, 1.0}) {
        CAPTURE(x, y, z);
        f.lights[0].position = {x, y, z};
        check(f, counting(x == 0.0 ? 2 : 4));
      }
  f.lights[0].directional = true;
  for (const glm::dvec3& d : {glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1)}) {
    f.lights[0].direction = d;
    check(f, counting(2));
  }
}

TEST_CASE("family 26: counting volumes that reach further give the same picture, up to near ties") {
  Random random(test_seed(6));
  CAPTURE(test_seed(6));
  for (int i = 0; i < 30; ++i) {
    const Config config = counting(2 + i % 7);
    CAPTURE(i, config.dsf_bits);
    const SceneFrame f = i % 2 == 0 ? random_scene(random, 5) : torn_scene(random);
    Look further;
    further.extrusion = 3;
    same_but_near_ties(make_geometry(f, config, kWidth, kHeight), config,
                       make_geometry(f, config, kWidth, kHeight, {.look = further}), config);
  }
}

TEST_CASE("family 27: a face that is a cap of a counting volume has no acne, at any angle") {
  Random random(test_seed(7));
  CAPTURE(test_seed(7));
  for (int i = 0; i < 100; ++i) {
    SceneFrame f;
    add_solid(f, i % 2 == 0 ? octahedron_solid() : box_solid(), {0, 0, 0}, {1, 1, 1}, random_turn(random), {1, 1, 1},
              false, i % 4 < 2);
    look_at(f.camera, {0, 0, 3}, {0, 0, 0});
    f.lights[0].direction = random_direction(random);
    const Config config = counting(2 + i % 7);
    CAPTURE(i, config.dsf_bits);
    const FrameGeometry g = make_geometry(f, config, kWidth, kHeight);
    Oracle oracle(g, config);
    std::uint64_t lit_and_shadowed = 0;
    for (int y = 0; y < kHeight; ++y) {
      oracle.line(y);
      for (int x = 0; x < kWidth; ++x) {
        const OraclePixel p = oracle.at(x);
        if (!p.shadowed || near_volume_edge(g, x, y, 1.5)) continue;
        // Convex and closed, it casts no shadow on its lit faces; open, only from within.
        const ScreenPolygon& surface = g.polygons[static_cast<std::uint32_t>(p.surface)];
        if (surface.lit && i % 4 < 2) ++lit_and_shadowed;
      }
    }
    CHECK(lit_and_shadowed == 0);
    judge_all(f, config, kWidth, kHeight);
  }
}

TEST_CASE("family 28: open, inverted, inconsistent, non-manifold, torn casters count as rays say") {
  Random random(test_seed(8));
  CAPTURE(test_seed(8));
  for (int i = 0; i < 56; ++i) {
    const Config config = counting(2 + i % 7);
    const SceneFrame f = torn_scene(random);
    CAPTURE(i, config.dsf_bits);
    judge_all(f, config, kWidth, kHeight);
    const RayCount count = compare_with_rays(f, kWidth, kHeight, 1, config);
    INFO(count.text());
    CHECK(count.good());
    // One face at a time gives the same.
    Look per_face;
    per_face.volumes = VolumeWay::per_face;
    same_but_near_ties(make_geometry(f, config, kWidth, kHeight), config,
                       make_geometry(f, Config{}, kWidth, kHeight, {.look = per_face}), Config{});
  }
}

}  // namespace kage::verif
