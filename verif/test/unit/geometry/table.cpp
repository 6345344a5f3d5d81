// SPDX-License-Identifier: Apache-2.0
// Shares that shadows take from faces: a table, or one for a frame. Faces with points of a light behind them.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "geometry/kept_light.hpp"
#include "geometry/light_table.hpp"
#include "geometry/view.hpp"
#include "kage/geometry.hpp"
#include "kage/light.hpp"
#include "stimulus/scenes/lit_scenes.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

Light random_lamp(Random& random) {
  Light l;
  l.directional = random.chance(0.3);
  l.direction = random_direction(random);
  l.position = random_direction(random) * random.real(4, 9);
  l.falls_off = !l.directional;
  l.color = glm::dvec3(random.real(0.1, 1), random.real(0.1, 1), random.real(0.1, 1)) * (l.falls_off ? 9.0 : 0.5);
  return l;
}

SceneFrame lit_scene(Random& random, int lights) {
  SceneFrame f = random_scene(random, 8);
  f.lights.clear();
  for (int l = 0; l < lights; ++l) f.lights.push_back(random_lamp(random));
  return f;
}

Config tabled(int class_bits, int lights) {
  Config c;
  c.count_bits = 4;
  c.lights = lights;
  c.class_bits = class_bits;
  c.shade_frac = 16;
  return c;
}

double error_of(const SceneFrame& f, const Config& c, const Look& look) {
  const SampledLights lights(f, c, look, {});
  const Lighting lighting(f.lights, lights, f.camera.up, false);
  return LightTable(f, c, look, lights, lighting).error();
}

}  // namespace

TEST_CASE("classes stay where the camera goes, and each is one of the table's") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::uint64_t again = 0;
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    SceneFrame f = lit_scene(random, random.in(1, 3));
    const Config c = tabled(random.in(2, 5), static_cast<int>(f.lights.size()));
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> known;
    std::vector<std::array<std::uint32_t, 3>> shares;
    for (int view = 0; view < 4; ++view) {
      const glm::dvec3 eye = random_direction(random) * 9.0;
      look_at(f.camera, eye, {0, 0, 0});
      f.camera.up = {0, 1, 0};
      f.camera.perspective = true;
      const FrameGeometry g = make_geometry(f, c, 64, 48);
      REQUIRE(g.shares.size() % static_cast<std::size_t>(c.lights) == 0);
      const std::size_t classes = g.shares.size() / static_cast<std::size_t>(c.lights);
      REQUIRE(classes < std::size_t{1} << c.class_bits);
      if (view > 0) CHECK(g.shares == shares);
      shares = g.shares;
      for (std::uint32_t i = 0; i < g.drawn; ++i) {
        const ScreenPolygon& p = g.polygons[i];
        CHECK((p.normal_class > 0) == p.lit);
        if (!p.lit) continue;
        REQUIRE(p.normal_class <= classes);
        const Triangle& t = f.triangles[f.polygons[p.source].triangle];
        const glm::dvec3 a = f.vertices[t.vertex[0]];
        const bool outside =
            glm::dot(glm::cross(f.vertices[t.vertex[1]] - a, f.vertices[t.vertex[2]] - a), eye - a) > 0;
        const auto [at, fresh] = known.try_emplace({p.source, outside}, p.normal_class);
        CHECK(at->second == p.normal_class);
        again += fresh ? 0 : 1;
      }
    }
  }
  CHECK(again > 1000);
}

TEST_CASE("more classes are nearer, and enough of them are exact") {
  Random random(test_seed(1));
  CAPTURE(test_seed(1));
  for (int round = 0; round < 20; ++round) {
    SceneFrame f = lit_scene(random, random.in(1, 3));
    for (Light& l : f.lights) l.directional = true, l.falls_off = false;
    Config one;
    one.shade_frac = 16;
    const int lights = static_cast<int>(f.lights.size());
    double before = lights == 1 ? error_of(f, one, {}) : INFINITY;
    for (const int bits : {2, 4, 11}) {
      const double error = error_of(f, tabled(bits, lights), {});
      CAPTURE(round, bits, before);
      CHECK(error <= before * 1.02 + 0.01);
      before = error;
    }
    CHECK(before < 0.01);
    Look few;
    few.classes = 3;
    CHECK(error_of(f, tabled(11, lights), few) == error_of(f, tabled(2, lights), {}));
  }
}

TEST_CASE("no share for a whole frame has less error than the one that it has") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (int round = 0; round < 20; ++round) {
    const SceneFrame f = lit_scene(random, 1);
    Config c;
    c.shade_frac = 16;
    const double fitted = error_of(f, c, {});
    const FrameGeometry g = make_geometry(f, c, 64, 48);
    for (int i = 0; i <= 20; ++i) {
      Look look;
      look.darkening = i / 20.0;
      CHECK(error_of(f, c, look) >= fitted - 0.01);
      CHECK(make_geometry(f, c, 64, 48, {.look = look}).shade == std::lround(65536 * i / 20.0));
    }
    Look same;
    same.darkening = g.shade / 65536.0;
    CHECK(std::abs(error_of(f, c, same) - fitted) < 0.01);
  }
}

TEST_CASE("in a closed room with a lamp the walls are in the table, and each has a class of it") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, 0}, {3, 2, 3}, Turn{}, {0.7, 0.7, 0.7});
  add_solid(f, box_solid(), {0.8, -1, 0}, {0.3, 0.5, 0.3}, Turn{}, {0.2, 0.2, 0.2});
  look_at(f.camera, {-2, 0.5, -2}, {0.5, -0.5, 0.5});
  f.lights = {Light{}};
  f.lights[0].directional = false;
  f.lights[0].position = {0.5, 1.5, 0};
  for (const bool room_alone : {false, true}) {
    SceneFrame g = f;
    if (room_alone) {
      g.components.resize(1);
      g.polygons.resize(g.components[0].polygon_count);
      g.triangles.resize(g.components[0].count);
    }
    // A lamp within, one outside whose light no inner wall gets, and none that casts.
    for (const glm::dvec3& place : {glm::dvec3(0.5, 1.5, 0), glm::dvec3(0, 9, 0)}) {
      g.lights[0].position = place;
      for (const int bits : {1, 2, 4}) {
        const Config c = tabled(bits, 1);
        const FrameGeometry made = make_geometry(g, c, 64, 48);
        int lit = 0;
        for (std::uint32_t i = 0; i < made.drawn; ++i) {
          const ScreenPolygon& p = made.polygons[i];
          CHECK(p.normal_class * static_cast<std::size_t>(c.lights) <= made.shares.size());
          if (bits > 1) CHECK((p.normal_class > 0) == p.lit);
          lit += p.lit ? 1 : 0;
        }
        CHECK(lit > 0);
        if (bits == 1) CHECK(made.shade > 0);
      }
    }
  }
}

TEST_CASE("light may be kept from where casters stand before it, and nowhere else") {
  SceneFrame f;
  for (int x = -4; x <= 4; ++x) add_solid(f, pane_solid(), {x, 0, 0}, {0.4, 0.4, 1}, Turn{}, {1, 1, 1}, false, false);
  const std::size_t floor = f.polygons.size();
  add_solid(f, box_solid(), {0, 0, 2}, {0.5, 0.5, 0.2}, Turn{}, {1, 1, 1});
  const KeptLight kept(f);
  Light lamp;
  lamp.directional = false;
  lamp.position = {0, 0, 8};
  int may = 0;
  for (const Component& part : f.components)
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count && i < floor; ++i) {
      double x = 0;
      for (const std::uint32_t v : f.outline(f.polygons[i])) x += f.vertices[v].x / f.polygons[i].count;
      CAPTURE(i, x);
      const bool is = kept.may_be(i, part, 1, lamp);
      may += is ? 1 : 0;
      if (std::abs(x) < 0.5) CHECK(is);
      if (std::abs(x) > 2.1) CHECK_FALSE(is);
    }
  CHECK(may > 0);
  // Towards a sun on the other side nothing stands; the lamp's own size may bring the box between.
  Light sun;
  sun.direction = {0, 0, 1};
  CHECK_FALSE(kept.may_be(0, f.components[0], 1, sun));
  CHECK_FALSE(kept.may_be(0, f.components[0], 1, lamp));
  lamp.shape = LightShape::disc;
  lamp.axis_u = {4, 0, 0};
  lamp.axis_v = {0, 4, 0};
  CHECK(kept.may_be(0, f.components[0], 1, lamp));
}

TEST_CASE("a frame's light asks for a table where shares differ, and for smooth colour where light does") {
  const auto demand = [](const char* name) {
    for (const LitScene& lit : lit_scenes())
      if (lit.name == name) return light_demand(Scene::from(lit.parts).frame(0, 1), {}, {});
    throw std::runtime_error(name);
  };
  CHECK(demand("low-sun").share_error > 3);
  CHECK(demand("lamp").share_error > 10);
  CHECK(demand("two-triangles").color_spread > 30);
  // A floor and a box under a sun: shadows fall on the floor alone, whose share is one.
  SceneFrame f;
  add_solid(f, pane_solid(), {0, 0, 0}, {9, 9, 1}, Turn{}, {1, 1, 1}, false, false);
  add_solid(f, box_solid(), {0, 0, 2}, {0.5, 0.5, 0.2}, Turn{}, {1, 1, 1});
  f.lights = {Light{}};
  f.lights[0].direction = {0, 0, -1};
  const LightDemand even = light_demand(f, {}, {});
  CHECK(even.share_error < 0.6);  // SHADE has 8 bits
  CHECK(even.color_spread == 0);
  // A lamp over the floor's middle, and a cone within it: its corners are alike, and light between them is not.
  look_at(f.camera, {3, 4, 5}, {0, 0, 0});
  Light& lamp = f.lights[0];
  lamp.directional = false;
  lamp.position = {0, 0, 1};
  CHECK(light_demand(f, {}, {}).color_spread > 30);
  lamp.spot = true;
  lamp.outer_cosine = 0.9;
  lamp.inner_cosine = 0.95;
  CHECK(light_demand(f, {}, {}).color_spread > 30);

  Needs needs;
  needs.shadows = true;
  Config c;
  CHECK(approximates(c, needs).empty());
  needs.share_error = 1.5;
  CHECK(approximates(c, needs).size() == 1);
  needs.color_spread = 1.5;
  CHECK(approximates(c, needs).size() == 2);
  c.count_bits = 1;
  c.class_bits = 4;
  CHECK(approximates(c, needs).size() == 1);
  c.smooth = 1;
  CHECK(approximates(c, needs).empty());
  needs.shadows = false;
  c.class_bits = 1;
  CHECK(approximates(c, needs).empty());
}

TEST_CASE("a face takes shadow where some sample of the light is before it, and shows all that they give") {
  SceneFrame f;
  add_solid(f, pane_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {0.3, 0.3, 0.3}, false, false);
  look_at(f.camera, {0.5, 0.5, 5}, {0, 0, 0});
  Light& l = f.lights[0];
  l.directional = false;
  l.shape = LightShape::disc;
  l.axis_u = {0, 0, 1};
  l.axis_v = {1, 0, 0};
  for (const int class_bits : {1, 4}) {
    Config c = tabled(class_bits, 1);
    const auto made = [&](double z) {
      l.position = {0, 0, z};
      FrameGeometry g = make_geometry(f, c, 64, 48);
      REQUIRE(g.drawn > 0);
      return g;
    };
    CHECK(made(1.1).polygons[0].lit);
    CHECK(made(0.5).polygons[0].lit);   // some of its 15 samples are behind
    CHECK(made(-0.5).polygons[0].lit);  // most are
    CHECK_FALSE(made(-1.5).polygons[0].lit);
    // The pane's own shadow, of those behind, leaves what the others give.
    for (const double z : {0.8, 0.5, 0.1, -0.5}) {
      const FrameGeometry g = made(z);
      const auto points = light_points(l, 15, Look{}.seed);
      const auto behind =
          std::count_if(points.begin(), points.end(), [](const LightPoint& p) { return p.position.z < 0; });
      REQUIRE(behind > 0);
      const double share =
          std::ldexp(class_bits > 1 ? g.shares[g.polygons[0].normal_class - 1][0] : g.shade, -c.shade_frac);
      double light = 0;  // at the corners, whose mean the face has
      for (const glm::dvec3& at : f.vertices)
        for (const LightPoint& p : points)
          if (p.position.z > 0) {
            Light one = l;
            one.position = p.position;
            light += received(one, at, {0, 0, 1}).x / 15;
          }
      CAPTURE(class_bits, z, behind, share);
      CHECK(share > 0);
      const double shown = g.polygons[0].color[0] * (1 - share * static_cast<double>(behind));
      const double all = 255 * srgb_encode(0.3 * (0.24 + 0.8 * light / 4));
      CHECK(std::abs(shown - all) < 4);
    }
  }
}

}  // namespace kage::verif
