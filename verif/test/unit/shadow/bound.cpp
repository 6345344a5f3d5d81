// SPDX-License-Identifier: Apache-2.0
// The bound on how many caps a ray of light meets, against the exact largest number: never below, and how far above.
#include <algorithm>
#include <array>

#include "casters.hpp"
#include "shadow/light_space.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

CountRange bound(const Caster& c, int target) {
  return LightSpace(c.frame, c.light, c.caps).count(c.caps, c.sides, target);
}

}  // namespace

TEST_CASE("the bound on caps that light meets is never below the exact number, and mostly the number") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::array<int, 8> above_by{};
  for (int i = 0; i < 400; ++i) {
    CAPTURE(i);
    // On a coarse grid now and then: vertices on edges, edges on each other, common vertices.
    const bool directional = i % 2 == 0;
    const bool coarse = i % 4 < 2;
    const Solid s = random_faces(random, directional, coarse, 14);
    if (s.faces.empty()) continue;
    const Caster c = caster_of(s, above(directional));
    if (c.caps.empty()) continue;
    const int exact = exact_from_above(c, c.caps);
    const CountRange r = bound(c, -1);
    CAPTURE(exact, r.low, r.high);
    CHECK(r.high >= exact);
    // Edges that ought to touch may overlap by the rounding of light space.
    if (!coarse) CHECK(r.low <= exact);
    ++above_by[static_cast<std::size_t>(std::clamp(r.high - exact, 0, 7))];
    // A bound for a target answers whether the target is met, by whichever way.
    for (const int target : {0, 1, 3}) {
      const CountRange told = bound(c, target);
      CHECK(told.high >= exact);
      CHECK((told.high <= target) == (r.high <= target));
    }
  }
  INFO("above by 0 .. 7 and more: " << above_by[0] << ' ' << above_by[1] << ' ' << above_by[2] << ' ' << above_by[3]
                                    << ' ' << above_by[4] << ' ' << above_by[5] << ' ' << above_by[6] << ' '
                                    << above_by[7]);
  CHECK(above_by[0] > 300);
  CHECK(above_by[7] < 10);
}

TEST_CASE("the bound holds all round a light: closed bodies about it, one in another") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    SceneFrame f;
    const int n = random.in(1, 6);
    for (int k = 1; k <= n; ++k)
      add_solid(f, i % 2 == 0 ? box_solid() : octahedron_solid(), {0, 0, 0}, glm::dvec3(k),
                i % 3 == 0 ? Turn{} : random_turn(random), {1, 1, 1}, false, true);
    LightPoint light;
    light.directional = false;
    light.position = {random.real(-0.3, 0.3), random.real(-0.3, 0.3), i % 4 == 0 ? 0.0 : random.real(-0.3, 0.3)};
    const std::vector<CapFace> all = casting_faces(f, light);
    std::vector<SideEdge> sides;
    EdgeTable(f).sides(f, all, sides);
    CHECK(sides.empty());
    const CountRange r = LightSpace(f, light, all).count(all, sides, -1);
    // Each body once in every direction.
    CHECK(r.high == n);
  }
}

TEST_CASE("faces that a ray of light meets both have boxes that overlap, all round a light") {
  Random random(test_seed(4));
  CAPTURE(test_seed(4));
  int checked = 0;
  for (int i = 0; i < 2000; ++i) {
    CAPTURE(i);
    SceneFrame f;
    // A large face, a small one behind a point of it, and one far aside, so that the light has something all round.
    Solid s;
    for (int k = 0; k < 3; ++k) s.vertices.push_back(random_direction(random) * random.real(1, 3));
    double a = random.real(0, 1);
    double b = random.real(0, 1);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const glm::dvec3 on = s.vertices[0] + a * (s.vertices[1] - s.vertices[0]) + b * (s.vertices[2] - s.vertices[0]);
    for (int k = 0; k < 3; ++k) s.vertices.push_back(on * random.real(2, 3) + random_direction(random) * 1e-3);
    for (int k = 0; k < 3; ++k) s.vertices.push_back(-on * 2.0 + random_direction(random));
    s.faces = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    LightPoint light;
    light.directional = false;
    add_solid(f, s, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
    const std::vector<CapFace> caps = casting_faces(f, light);
    const LightSpace space(f, light, caps);
    if (caps.size() != 3 || space.one_chart()) continue;
    // The ray through `on` may miss the small face, by as much as that is wide.
    const LightBox large = space.box(f.polygons[0]);
    LightBox small = space.box(f.polygons[1]);
    for (std::size_t k = 0; k < 2; ++k) small.low[k] -= 1e-3, small.high[k] += 1e-3;
    CHECK(large.overlaps(small));
    ++checked;
  }
  CHECK(checked > 1000);
}

TEST_CASE("the bound holds where bodies stand round a light") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    SceneFrame f;
    for (int k = 0; k < 8; ++k) {
      const glm::dvec3 d = random_direction(random);
      for (const double r : {3.0, 5.0})
        if (random.chance(0.7))
          add_solid(f, box_solid(), d * r, glm::dvec3(random.real(0.2, 1)), random_turn(random), {1, 1, 1}, false,
                    random.chance(0.5));
    }
    if (f.components.empty()) continue;
    LightPoint light;
    light.directional = false;
    const std::vector<CapFace> all = casting_faces(f, light);
    std::vector<SideEdge> sides;
    EdgeTable(f).sides(f, all, sides);
    const LightSpace space(f, light, all);
    const CountRange r = space.count(all, sides, -1);
    // Rays of light, towards all corners and between them.
    int most = 0;
    for (int k = 0; k < 3000; ++k) {
      const glm::dvec3 d = random_direction(random);
      int met = 0;
      for (const CapFace& cap : all) {
        const auto o = f.outline(f.polygons[cap.polygon]);
        bool in = true;
        for (std::size_t e = 0; e < 3; ++e) {
          const double s = glm::dot(d, glm::cross(f.vertices[o[e]], f.vertices[o[(e + 1) % 3]]));
          in = in && (cap.turned ? s > 0 : s < 0);
        }
        met += in ? 1 : 0;
      }
      most = std::max(most, met);
    }
    CAPTURE(most, r.low, r.high);
    CHECK(r.high >= most);
    CHECK(r.high <= most + 3);
  }
}

}  // namespace kage::verif
