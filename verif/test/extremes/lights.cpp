// SPDX-License-Identifier: Apache-2.0
// Families 29 and 30 over whole frames: several lights, several samples of each.
#include <fmt/format.h>

#include <cstdio>

#include "kage/light.hpp"
#include "oracle/light_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

Light random_light(Random& random) {
  Light l;
  l.directional = random.chance(0.3);
  l.direction = random_direction(random);
  l.position = {random.real(-4, 4), random.real(-2, 5), random.real(-4, 4)};
  l.color = {random.real(0, 1), random.real(0, 1), random.real(0, 1)};
  l.falls_off = !l.directional && random.chance(0.5);
  if (l.falls_off) l.color *= 10.0;
  if (l.falls_off && random.chance(0.3)) l.range = random.real(3, 12);
  l.spot = !l.directional && random.chance(0.3);
  l.outer_cosine = random.real(0, 0.8);
  l.inner_cosine = random.real(l.outer_cosine + 0.01, 1);
  if (l.directional || random.chance(0.3)) return l;
  l.shape = static_cast<LightShape>(random.in(1, 3));
  const double size = random.real(0.05, 1.5);
  const Turn turn = random_turn(random);
  l.axis_u = l.shape == LightShape::sphere ? glm::dvec3(size, 0, 0) : turn.x * size;
  l.axis_v = turn.y * size;
  return l;
}

}  // namespace

TEST_CASE("family 29: a picture of several lights and samples follows from their hard shadows, pixel by pixel") {
  const std::uint64_t seed = test_seed(29);
  std::uint64_t partly = 0;
  std::uint64_t several = 0;
  for (int round = 0; round < 24; ++round) {
    INFO(fmt::format("KAGE_SEED={} round {}", seed, round));
    Random random(seed + static_cast<std::uint64_t>(round));
    SceneFrame f = random_scene(random, random.in(2, 8));
    f.lights.clear();
    for (int l = random.in(1, 8); l > 0; --l) f.lights.push_back(random_light(random));
    Look look;
    look.samples = std::array{1, 2, 3, 4, 7, 8, 15}[static_cast<std::size_t>(random.in(0, 6))];
    look.seed = static_cast<std::uint64_t>(round);
    Config c;
    c.smooth = random.in(0, 1);
    c.color_frac = 6 * c.smooth;
    c = config_for_lights(f, look.samples, c);
    if (c.class_bits > 1) c.class_bits = random.in(2, 11);
    const FrameGeometry g = make_geometry(f, c, 64, 48, {.look = look});
    const auto expected = expected_picture(g, c);
    const auto got = draw(g, c);
    REQUIRE(got.size() == expected.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      wrong += got[i] != expected[i] ? 1 : 0;
      if (wrong == 1 && got[i] != expected[i])
        UNSCOPED_INFO(fmt::format("({}, {}): {:06x} for {:06x}", i % 64, i / 64, got[i], expected[i]));
    }
    CHECK(wrong == 0);
    for (const auto& n : shadow_counts(g, c)) {
      for (std::size_t l = 0; l < f.lights.size(); ++l) {
        const auto all = std::count(g.sample_light.begin(), g.sample_light.end(), l);
        REQUIRE(n[l] <= all);
        partly += n[l] > 0 && n[l] < all ? 1 : 0;
      }
      several += std::count_if(n.begin(), n.end(), [](std::uint32_t k) { return k > 0; }) > 1 ? 1 : 0;
    }
  }
  std::printf("family 29: %zu pixels in part of a light, %zu in shadows of several\n", static_cast<std::size_t>(partly),
              static_cast<std::size_t>(several));
  CHECK(partly > 1000);
  CHECK(several > 1000);
}

TEST_CASE("family 29: N equal samples give 0 or N, and the picture of one sample to within their rounding") {
  Random random(test_seed(2));
  for (const int n : {1, 3, 4, 255}) {
    SceneFrame f = random_scene(random, 5);
    f.lights[0].directional = false;
    f.lights[0].position = {2, 4, 1};
    f.lights[0].shape = LightShape::disc;  // of no size
    Look look;
    look.samples = n;
    Config c;
    c.count_bits = 8;
    c.shade_frac = 16;
    const FrameGeometry g = make_geometry(f, c, 48, 36, {.look = look});
    REQUIRE(g.sample_light.size() == static_cast<std::size_t>(n));
    for (const auto& k : shadow_counts(g, c)) REQUIRE((k[0] == 0 || k[0] == static_cast<std::uint32_t>(n)));
    Look one = look;
    one.samples = 1;
    const auto many = draw(g, c);
    const auto single = draw(make_geometry(f, c, 48, 36, {.look = one}), c);
    // n shares are each rounded by half of 2^-16: of 255, less than half an LSB, and a rounding of the colour.
    for (std::size_t i = 0; i < many.size(); ++i)
      for (unsigned k = 0; k < 24; k += 8)
        REQUIRE(std::abs(static_cast<int>(many[i] >> k & 255U) - static_cast<int>(single[i] >> k & 255U)) <= 1);
  }
}

TEST_CASE("a sample's shadow is that of a scene with a light there and no other") {
  Random random(test_seed(3));
  for (int round = 0; round < 12; ++round) {
    SceneFrame f = random_scene(random, 6);
    f.lights = {random_light(random), random_light(random), random_light(random)};
    Look look;
    look.samples = 4;
    Config c = config_for_lights(f, look.samples);
    const FrameGeometry g = make_geometry(f, c, 64, 48, {.look = look});
    std::uint32_t sample = 0;
    for (std::size_t l = 0; l < f.lights.size(); ++l)
      for (const LightPoint& p : light_points(f.lights[l], look.samples, look.seed + l)) {
        SceneFrame alone = f;
        Light light;
        static_cast<LightPoint&>(light) = p;
        alone.lights = {light};
        const FrameGeometry h = make_geometry(alone, for_one_sample(c), 64, 48, {.look = look});
        const bool same = sample_shadow(g, c, sample) == sample_shadow(h, c, 0);
        REQUIRE(same);
        ++sample;
      }
    CHECK(sample == g.sample_light.size());
  }
}

TEST_CASE("more samples than the counter holds, or more lights than there are, are refused") {
  Random random(4);
  SceneFrame f = random_scene(random, 2);
  f.lights[0].directional = false;
  f.lights[0].shape = LightShape::sphere;
  f.lights[0].axis_u = {1, 0, 0};
  Config c;
  c.count_bits = 3;
  c.shade_frac = 12;
  Look look;
  look.samples = 7;
  CHECK_NOTHROW(make_geometry(f, c, 16, 16, {.look = look}));
  look.samples = 8;
  CHECK_THROWS_WITH(make_geometry(f, c, 16, 16, {.look = look}), "8 samples of a light do not fit COUNT_BITS = 3");
  f.lights.resize(kMaxLights + 1);
  CHECK_THROWS_WITH(make_geometry(f, c, 16, 16, {.look = look}), "65 lights: there must be 1 .. 64");
  f.lights.clear();
  CHECK_THROWS_WITH(make_geometry(f, c, 16, 16, {.look = look}), "0 lights: there must be 1 .. 64");
}

}  // namespace kage::verif
