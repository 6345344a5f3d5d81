// SPDX-License-Identifier: Apache-2.0
// The bound on how many caps a ray of light meets, against the exact largest number: never below, and how far above.
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <functional>

#include "catch.hpp"
#include "shadow/light_space.hpp"
#include "shadow/shadow_caster.hpp"
#include "support/shapes.hpp"

namespace kage::verif {
namespace {

using Rational = boost::multiprecision::cpp_rational;

struct ExactPoint {
  Rational x, y;
};
using ExactPolygon = std::vector<ExactPoint>;

Rational turn(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// What of a convex polygon lies left of the way from a to b; empty if it has no area.
ExactPolygon left_of(const ExactPolygon& polygon, const ExactPoint& a, const ExactPoint& b) {
  ExactPolygon out;
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const ExactPoint& p = polygon[i];
    const ExactPoint& q = polygon[(i + 1) % polygon.size()];
    const Rational dp = turn(a, b, p);
    const Rational dq = turn(a, b, q);
    inside = inside || dp > 0;
    if (dp >= 0) out.push_back(p);
    if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) {
      const Rational t = dp / (dp - dq);
      out.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
    }
  }
  if (!inside) out.clear();
  return out;
}

/// The most triangles, all counter-clockwise, that have an open set in common.
int exact_most(const std::vector<ExactPolygon>& triangles) {
  int most = 0;
  const std::function<void(const ExactPolygon&, std::size_t, int)> go = [&](const ExactPolygon& common,
                                                                            std::size_t from, int count) {
    most = std::max(most, count);
    for (std::size_t i = from; i < triangles.size(); ++i) {
      // Not even with all that are left.
      if (count + static_cast<int>(triangles.size() - i) <= most) return;
      ExactPolygon next = common.empty() ? triangles[i] : common;
      for (std::size_t k = 0; k < 3 && !common.empty() && !next.empty(); ++k)
        next = left_of(next, triangles[i][k], triangles[i][(k + 1) % 3]);
      if (!next.empty()) go(next, i + 1, count + 1);
    }
  };
  go({}, 0, 0);
  return most;
}

struct Caster {
  SceneFrame frame;
  LightPoint light;
  std::vector<CapFace> caps;
  std::vector<SideEdge> sides;
};

/// Triangles as one component, with all faces turned to the light.
Caster caster_of(const Solid& s, const LightPoint& light) {
  Caster c;
  add_solid(c.frame, s, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  c.light = light;
  ShadowCaster(c.frame, light, {}, 1).caps(c.frame.components[0], c.caps);
  EdgeTable(c.frame).sides(c.frame, c.caps, c.sides);
  return c;
}

CountRange bound(const Caster& c, int target) {
  return LightSpace(c.frame, c.light, c.caps).count(c.caps, c.sides, target);
}

/// In the plane that a light straight above sees.
int exact_from_above(const Caster& c) {
  std::vector<ExactPolygon> triangles;
  for (const CapFace& cap : c.caps) {
    ExactPolygon t;
    for (const std::uint32_t v : c.frame.outline(c.frame.polygons[cap.polygon])) {
      const glm::dvec3& p = c.frame.vertices[v];
      if (c.light.directional)
        t.push_back({Rational(p.x), Rational(-p.z)});
      else  // below the light at the origin
        t.push_back({Rational(p.x) / Rational(-p.y), Rational(-p.z) / Rational(-p.y)});
    }
    if (turn(t[0], t[1], t[2]) < 0) std::swap(t[1], t[2]);
    triangles.push_back(std::move(t));
  }
  return exact_most(triangles);
}

LightPoint above(bool directional) {
  LightPoint l;
  l.directional = directional;
  return l;
}

}  // namespace

TEST_CASE("the bound on caps that light meets is never below the exact number, and mostly the number") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::array<int, 8> above_by{};
  for (int i = 0; i < 400; ++i) {
    CAPTURE(i);
    Solid s;
    const bool directional = i % 2 == 0;
    // On a coarse grid now and then: vertices on edges, edges on each other, common vertices.
    const bool coarse = i % 4 < 2;
    const int points = random.in(3, 12);
    for (int k = 0; k < points; ++k) {
      const auto place = [&] { return coarse ? static_cast<double>(random.in(-3, 3)) : random.real(-3, 3); };
      s.vertices.emplace_back(place(), directional || !coarse ? random.real(-9, -1) : -random.in(1, 2), place());
    }
    const int faces = random.in(1, 14);
    while (static_cast<int>(s.faces.size()) < faces) {
      std::array<std::uint32_t, 3> f{};
      for (auto& v : f) v = static_cast<std::uint32_t>(random.in(0, points - 1));
      if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) s.faces.push_back(f);
      if (random.chance(0.01)) break;
    }
    if (s.faces.empty()) continue;
    const Caster c = caster_of(s, above(directional));
    if (c.caps.empty()) continue;
    const int exact = exact_from_above(c);
    const CountRange r = bound(c, 0);
    CAPTURE(exact, r.low, r.high);
    CHECK(r.high >= exact);
    // Edges that ought to touch may overlap by the rounding of light space.
    if (!coarse) CHECK(r.low <= exact);
    ++above_by[static_cast<std::size_t>(std::clamp(r.high - exact, 0, 7))];
    // What a target asks for is answered, whichever way.
    for (const int target : {1, 3}) CHECK(bound(c, target).high >= std::min(exact, r.high));
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
    const ShadowCaster caster(f, light, {}, 1);
    std::vector<CapFace> all;
    std::vector<CapFace> caps;
    for (const Component& c : f.components) {
      caster.caps(c, caps);
      all.insert(all.end(), caps.begin(), caps.end());
    }
    std::vector<SideEdge> sides;
    EdgeTable(f).sides(f, all, sides);
    CHECK(sides.empty());
    const CountRange r = LightSpace(f, light, all).count(all, sides, 0);
    // Each body once in every direction.
    CHECK(r.high == n);
  }
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
    const ShadowCaster caster(f, light, {}, 1);
    std::vector<CapFace> all;
    std::vector<CapFace> caps;
    for (const Component& c : f.components) {
      caster.caps(c, caps);
      all.insert(all.end(), caps.begin(), caps.end());
    }
    std::vector<SideEdge> sides;
    EdgeTable(f).sides(f, all, sides);
    const LightSpace space(f, light, all);
    const CountRange r = space.count(all, sides, 0);
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
