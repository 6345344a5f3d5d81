// SPDX-License-Identifier: Apache-2.0
// Patches: their faces are free of overlap in rational numbers, each is in one of them, and they are as large as can
// be.
#include "shadow/patches.hpp"

#include <cmath>
#include <set>

#include "casters.hpp"
#include "shadow/light_corners.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

std::vector<std::vector<CapFace>> patches_of(const Caster& c) {
  return make_patches(c.frame, c.light, EdgeTable(c.frame), LightSpace(c.frame, c.light, c.caps), c.caps);
}

/// n x n squares of a height field with bumps `steep` high, their corners a little aside.
Solid field(Random& random, int n, double steep) {
  Solid s;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      s.vertices.emplace_back(x + random.real(-0.2, 0.2), -5 + random.real(0, steep), y + random.real(-0.2, 0.2));
  const auto at = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      s.faces.push_back({at(x, y), at(x, y + 1), at(x + 1, y)});
      s.faces.push_back({at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)});
    }
  return s;
}

}  // namespace

TEST_CASE("no two faces of a patch overlap as the light sees them, and each face is in one patch") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::size_t faces = 0;
  std::size_t patches = 0;
  for (int i = 0; i < 400; ++i) {
    CAPTURE(i);
    const bool directional = i % 2 == 0;
    const Caster c = caster_of(random_faces(random, directional, i % 4 < 2, 24), above(directional));
    std::set<std::uint32_t> seen;
    for (const auto& patch : patches_of(c)) {
      CHECK(exact_from_above(c, patch) == 1);
      for (const CapFace& cap : patch) CHECK(seen.insert(cap.polygon).second);
      ++patches;
    }
    CHECK(seen.size() == c.caps.size());
    faces += c.caps.size();
  }
  CAPTURE(faces, patches);
  CHECK(patches < faces);
}

TEST_CASE("a height field under a light straight above is one patch, turned faces and all") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (const double steep : {0.0, 1.0, 50.0}) {
    Solid s = field(random, 20, steep);
    CHECK(patches_of(caster_of(s, above(true))).size() == 1);
    for (auto& f : s.faces)
      if (random.chance(0.5)) std::swap(f[0], f[1]);
    CHECK(patches_of(caster_of(s, above(true))).size() == 1);
  }
}

TEST_CASE("a fan of slices as long as all of it is one patch, two fans are two") {
  // A slice's box lies in about a quarter of all cells of a fine grid.
  for (const std::uint32_t n : {3U, 40U, 3000U}) {
    CAPTURE(n);
    Solid s;
    const auto fan = [&](double y) {
      const auto middle = static_cast<std::uint32_t>(s.vertices.size());
      s.vertices.emplace_back(0, y, 0);
      for (std::uint32_t i = 0; i < n; ++i)
        s.vertices.emplace_back(10 * std::cos(6.28 * i / n), y, 10 * std::sin(6.28 * i / n));
      for (std::uint32_t i = 1; i < n; ++i) s.faces.push_back({middle, middle + i, middle + i + 1});
    };
    fan(-5);
    CHECK(patches_of(caster_of(s, above(true))).size() == 1);
    fan(-6);
    CHECK(patches_of(caster_of(s, above(true))).size() == 2);
  }
}

TEST_CASE("a sheet folded n times is n patches, however thin its folds") {
  for (const double thin : {1.0, 1e-3, 1e-9, 0x1p-40})
    for (int n = 1; n < 9; ++n) {
      CAPTURE(thin, n);
      Solid s;
      for (int i = 0; i <= n; ++i)
        for (const double z : {-1.0, 1.0}) s.vertices.emplace_back(i % 2 == 0 ? -1 : 1, -2 - thin * i, z);
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
        s.faces.push_back({2 * i, 2 * i + 1, 2 * i + 3});
        s.faces.push_back({2 * i, 2 * i + 3, 2 * i + 2});
      }
      CHECK(patches_of(caster_of(s, above(true))).size() == static_cast<std::size_t>(n));
    }
}

TEST_CASE("on which side of an edge a corner lies is exact") {
  SceneFrame f;
  const double up = std::nextafter(1.0, 2.0);
  f.vertices = {{0, 0, 0}, {3, 0, 3}, {1, 7, 1}, {1, -3, up}, {up, 5, 1}};
  LightPoint light;  // straight down: x to the right, -z up
  CHECK(light_turn(f, light, 0, 1, 2) == 0);
  CHECK(light_turn(f, light, 0, 1, 3) == -1);
  CHECK(light_turn(f, light, 0, 1, 4) == 1);
  CHECK(light_turn(f, light, 1, 0, 4) == -1);
  light.directional = false;
  light.position = {0, 20, 0};
  CHECK(light_turn(f, light, 0, 1, 2) == 0);
  CHECK(light_turn(f, light, 0, 1, 3) == -1);
  CHECK(light_turn(f, light, 0, 1, 4) == 1);
}

TEST_CASE("corners of caps go round as their vertices do, near or far, thin or not") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  int left = 0;
  int told = 0;
  for (int round = 0; round < 4000; ++round) {
    const bool directional = random.chance(0.5);
    const double size = std::ldexp(1.0, random.in(-8, 8) * (random.chance(0.1) ? 100 : 1));
    const double off = random.chance(0.5) ? 0 : std::ldexp(size, random.in(0, 40));
    const auto point = [&](double away) {
      return glm::dvec3(away + size * random.real(-1, 1), away + size * random.real(-1, 1),
                        away + size * random.real(-1, 1));
    };
    LightPoint light;
    light.directional = directional;
    light.position = point(random.chance(0.5) ? off : 0);
    light.direction = glm::normalize(glm::dvec3(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)));
    if (random.chance(0.2)) light.direction = {0, random.chance(0.5) ? 1 : -1, 0};
    SceneFrame f;
    for (int i = 0; i < 6; ++i) f.vertices.push_back(point(off));
    // Some in one plane with the light, but for rounding; some in the same place.
    for (std::size_t i = 3; i < 6; ++i) {
      const glm::dvec3 on = glm::mix(f.vertices[0], f.vertices[1], random.real(-1, 2));
      const glm::dvec3 way = directional ? light.direction * size : on - light.position;
      if (random.chance(0.4)) f.vertices[i] = on + way * random.real(-0.5, 0.5);
      if (random.chance(0.1)) f.vertices[i] = f.vertices[1];
    }
    f.corners = {0, 1, 2, 3, 4, 5, 1, 0, 3};
    for (std::uint32_t i = 0; i < 3; ++i) {
      f.polygons.emplace_back();
      f.polygons[i].first = 3 * i;
      f.polygons[i].count = 3;
    }
    const std::vector<CapFace> caps{{0, false}, {1, true}, {2, random.chance(0.5)}};
    const LightCorners corners(f, light, caps);
    const auto vertex = [&](std::uint32_t cap, std::uint32_t i) {
      return f.corners[3 * cap + (caps[cap].turned ? 2 - i : i)];
    };
    CAPTURE(round, directional, size, off);
    for (std::uint32_t p = 0; p < 9; ++p)
      for (std::uint32_t q = 0; q < 9; ++q)
        for (std::uint32_t r = 0; r < 9; ++r) {
          const auto number = [&](std::uint32_t k) { return corners.corner(k / 3, k % 3); };
          const auto of = [&](std::uint32_t k) { return vertex(k / 3, k % 3); };
          const int turn = light_turn(f, light, of(p), of(q), of(r));
          REQUIRE(corners.turn(number(p), number(q), number(r)) == turn);
          const bool sure = corners.surely_not_left(number(p), number(q), number(r));
          if (sure) REQUIRE(turn <= 0);
          if (turn < 0 && off == 0) {
            ++left;
            told += sure ? 1 : 0;
          }
        }
  }
  CAPTURE(left, told);
  CHECK(told > 0.6 * left);
  CHECK(told < left);
}

}  // namespace kage::verif
