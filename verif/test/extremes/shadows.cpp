// SPDX-License-Identifier: Apache-2.0
// Families 21, 22, 24 - 28: shadows, held against the oracle.
#include <cmath>

#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/scene/shadow_checks.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 72;

void judge_all(const SceneFrame& f) { verif::judge_all(f, {}, kWidth, kHeight); }

void sums_are_zero(const SceneFrame& f) { verif::sums_are_zero(f, {}, kWidth, kHeight); }

}  // namespace

TEST_CASE("family 21: with near and far caps the toggles of every volume sum to zero at every pixel") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    sums_are_zero(random_scene(random, 4, i % 2 == 0));
  }
}

TEST_CASE("family 21: covered pixels, surface and shadow are the oracle's at every pixel of random scenes") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (int i = 0; i < 120; ++i) {
    CAPTURE(i);
    judge_all(random_scene(random, random.in(1, 8), i % 3 != 0));
  }
}

TEST_CASE("family 21: the shadow is what a ray to the light says") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  rays_agree(
      60, [&](int i) { return compare_with_rays(random_scene(random, random.in(1, 6), i % 2 == 0), kWidth, kHeight); });
}

TEST_CASE("rays tell a lost volume, a lost face of one, a lost polygon and a moved vertex from what the snap does") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 0, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1});
  look_at(f.camera, {4, 5, 6}, {0, -1, 0});
  f.lights[0].direction = glm::normalize(glm::dvec3(0.4, -1, 0.3));
  const Config config;
  const FrameGeometry whole = make_geometry(f, config, kWidth, kHeight);
  REQUIRE(whole.volumes.size() == 2);
  const RayCount truth = compare_with_rays(f, whole, config);
  INFO(truth.text());
  CHECK(truth.good());
  CHECK(truth.shadowed > 100);

  FrameGeometry g = whole;
  g.volume_faces.resize(g.volumes.back().first_face);
  g.volumes.pop_back();
  CHECK(compare_with_rays(f, g, config).wrong_shadow > 100);
  g = whole;
  --g.volumes.back().face_count;
  g.volume_faces.pop_back();
  CHECK(compare_with_rays(f, g, config).wrong_shadow > 10);
  g = whole;
  for (const std::uint32_t i : {0U, g.drawn - 1})
    for (std::uint32_t v = 0; v < g.polygons[i].vertex_count; ++v) g.vertices[g.polygons[i].first_vertex + v] = {};
  CHECK(compare_with_rays(f, g, config).wrong_surface > 10);
  g = whole;
  for (ScreenVertex& v : g.vertices) v.x += 256;
  CHECK(compare_with_rays(f, g, config).wrong_surface > 10);
}

TEST_CASE("family 22: nested, overlapping and touching casters in any order give the same picture, the oracle's") {
  Random random(test_seed(4));
  CAPTURE(test_seed(4));
  for (int k = 0; k <= 64; ++k) {
    CAPTURE(k);
    std::vector<int> order(static_cast<std::size_t>(k));
    for (int i = 0; i < k; ++i) order[static_cast<std::size_t>(i)] = i;
    std::vector<std::uint32_t> first;
    for (int round = 0; round < 3; ++round) {
      const SceneFrame f = box_threes(order, 0.4);
      judge_all(f);
      const auto pixels = draw(make_geometry(f, Config{}, kWidth, kHeight), Config{});
      if (round == 0) first = pixels;
      CHECK(pixels == first);
      random.shuffle(order);
    }
  }
}

TEST_CASE(
    "family 24: eye inside, outside and on every shadow plane, plus and minus one ulp; near planes that cut volumes") {
  Random random(test_seed(5));
  CAPTURE(test_seed(5));
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 2, 0}, {1, 0.5, 1}, Turn{}, {1, 1, 1});
  add_solid(f, octahedron_solid(), {2.5, 1, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  f.lights[0].direction = {0, -1, 0};  // shadow planes of the box: x = +-1, z = +-1
  for (const double near : {0.01, 0.5, 2.0})
    for (const double x : {std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.0, 2.0), 0.0, 1.7, -1.0})
      for (const double z : {-1.0, std::nextafter(-1.0, 0.0), 0.3, 1.0}) {
        CAPTURE(near, x, z);
        look_at(f.camera, {x, -0.5, z}, {random.real(-4, 4), random.real(-3, 0), random.real(-4, 4)});
        f.camera.near = near;
        judge_all(f);
        sums_are_zero(f);
      }
}

TEST_CASE("family 24: a section with the plane at w0 that covers the whole line is IF, any other is not") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {20, 0.5, 20}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 2, 0}, {3, 0.5, 3}, Turn{}, {1, 1, 1});
  f.lights[0].direction = {0, -1, 0};  // depth begins at 2, where the picture is 2.7 wide
  Look look;
  look.leave_out = false;  // the shadow is behind the eye
  const auto counts = [&](const glm::dvec3& eye) {
    look_at(f.camera, eye, eye + glm::dvec3(0, -0.5, 1));
    std::vector<std::uint32_t> words;
    make_frame(make_geometry(f, Config{}, kWidth, kHeight, {.look = look}), Config{}, 0, words,
               {.threads = 1, .all_spans = true});
    return check_frame(Config{}, words, "test", 0).of_kind;
  };
  const auto kind = [](Kind k) { return static_cast<std::size_t>(k); };
  f.camera.near = 0.01;
  CHECK(counts({0, 0, 0})[kind(Kind::IF)] == kHeight);  // inside
  CHECK(counts({0, 0, 0})[kind(Kind::NC)] == 0);
  CHECK(counts({9, 0, 0})[kind(Kind::IF)] == 0);  // outside
  CHECK(counts({9, 0, 0})[kind(Kind::NC)] == 0);
  CHECK(counts({3, 0, 0})[kind(Kind::NC)] == kHeight);  // half of every line
  CHECK(counts({3, 0, 0})[kind(Kind::IF)] == 0);
}

TEST_CASE("family 25: light on a face's plane plus and minus one ulp, inside the caster, behind the eye, far away") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1});
  look_at(f.camera, {4, 3, 5}, {0, -1, 0});
  f.lights[0].directional = false;
  for (const double y : {1.0, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0), 1.0 + 1e-7, 0.0, 5.0, 1e6})
    for (const double x : {0.0, 1.0, 3.0, 30.0}) {
      CAPTURE(x, y);
      f.lights[0].position = {x, y, 0.25};
      judge_all(f);
      sums_are_zero(f);
    }
}

// Both volumes are the true one with its vertices snapped: where their pictures differ, one of them is unlike the true
// one's, and what the snap may do to it leaves the pixel open.
TEST_CASE("family 26: volumes that reach further give the same picture, up to near ties") {
  Random random(test_seed(6));
  CAPTURE(test_seed(6));
  std::size_t different = 0;
  std::size_t pixels = 0;
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_scene(random, 5);
    const Config config;
    Look further;
    further.extrusion = 3;
    different += same_but_near_ties(make_geometry(f, config, kWidth, kHeight), config,
                                    make_geometry(f, config, kWidth, kHeight, {.look = further}), config);
    pixels += std::size_t{kWidth} * kHeight;
  }
  CAPTURE(different);
  CHECK(different * 1000 < pixels);
}

TEST_CASE("family 27: a face that is the cap of its own volume has no acne, at any angle") {
  Random random(test_seed(7));
  CAPTURE(test_seed(7));
  for (int i = 0; i < 150; ++i) {
    CAPTURE(i);
    SceneFrame f;
    const bool one_face = i % 2 == 0;
    if (one_face)
      add_solid(f, Solid{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {0, 0, 0}, {1, 1, 1}, random_turn(random),
                {1, 1, 1}, false, false);
    else
      add_solid(f, octahedron_solid(), {0, 0, 0}, {1, 1, 1}, random_turn(random), {1, 1, 1});
    look_at(f.camera, {0, 0, 3}, {0, 0, 0});
    f.lights[0].direction = random_direction(random);
    const FrameGeometry g = make_geometry(f, Config{}, kWidth, kHeight);
    Oracle oracle(g, Config{});
    std::uint64_t lit_and_shadowed = 0;
    for (int y = 0; y < kHeight; ++y) {
      oracle.line(y);
      for (int x = 0; x < kWidth; ++x) {
        const OraclePixel p = oracle.at(x);
        // At the silhouette a side leaves the face in the same point; the snap may put it on either side there.
        if (p.shadowed && g.polygons[static_cast<std::uint32_t>(p.surface)].lit && !near_volume_edge(g, x, y, 1.5))
          ++lit_and_shadowed;
      }
    }
    CHECK(lit_and_shadowed == 0);
    judge_all(f);
  }
}

TEST_CASE("family 28: open, non-manifold and inverted casters shadow as rays say") {
  Random random(test_seed(8));
  CAPTURE(test_seed(8));
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    SceneFrame f;
    add_solid(f, box_solid(), {0, -2.5, 0}, {5, 0.2, 5}, Turn{}, {1, 1, 1});
    Solid open = random.chance(0.5) ? box_solid() : octahedron_solid();
    open.faces.pop_back();
    if (random.chance(0.5)) std::swap(open.faces[0][0], open.faces[0][1]);  // one face inverted
    if (random.chance(0.5)) open.faces.push_back({0, 3, 5});                // a fin: edges with three faces
    add_solid(f, open, {0, 0, 0}, {1.2, 1.2, 1.2}, random_turn(random), {1, 1, 1}, false, false);
    look_at(f.camera, {random.real(-4, 4), random.real(0, 4), random.real(2, 5)}, {0, -1, 0});
    f.lights[0].directional = random.chance(0.5);
    f.lights[0].direction = glm::normalize(glm::dvec3(random.real(-1, 1), -1.5, random.real(-1, 1)));
    f.lights[0].position = {random.real(-2, 2), 4, random.real(-2, 2)};
    judge_all(f);
    const RayCount count = compare_with_rays(f, kWidth, kHeight);
    INFO(count.text());
    CHECK(count.good());
  }
}

}  // namespace kage::verif
