// SPDX-License-Identifier: Apache-2.0
// The light table: what its entries are where it has room for all classes and where it has not, and which faces take
// shadow without one.
#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/light_table.hpp"
#include "scene/space.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

struct Face {
  glm::dvec3 normal;
  glm::dvec3 place;
  double area;
  std::bitset<kMaxLights> lit;
};

std::vector<Light> random_lights(Random& random, bool directional) {
  std::vector<Light> lights(static_cast<std::size_t>(random.in(1, 8)));
  for (Light& l : lights) {
    l.directional = directional || random.chance(0.3);
    l.direction = random_direction(random);
    l.position = random_direction(random) * random.real(3, 6);
    l.falls_off = !l.directional;
    l.color = glm::dvec3(random.real(0.1, 1), random.real(0.1, 1), random.real(0.1, 1)) * (l.falls_off ? 5.0 : 0.5);
  }
  return lights;
}

/// Random lights, of which the first ones cast, and faces; their classes and the table.
struct Tabled {
  Tabled(Random& random, bool directional) : lights(random_lights(random, directional)) {
    config.lights = random.in(1, static_cast<int>(lights.size()));
    config.count_bits = 8;
    config.class_bits = random.in(2, 7);
    config.shade_frac = 16;
    look.classes = random.chance(0.2) ? random.in(1, 4) : random.in(1, 300);
    for (int l = 0; l < config.lights; ++l) samples.push_back(random.in(1, 255));
    LightTable table(config, look, lights, lighting, samples);
    for (int i = random.in(1, 300); i > 0; --i) {
      Face f{random_direction(random), random_direction(random) * random.real(0, 2), random.real(0.01, 4), {}};
      for (std::size_t l = 0; l < lights.size(); ++l) f.lit[l] = random.chance(0.6);
      f.lit[static_cast<std::size_t>(random.in(0, config.lights - 1))] = true;
      g.polygons.emplace_back().normal_class = table.classify(f.normal, f.place, f.area, f.lit);
      faces.push_back(f);
    }
    table.finish(g);
  }
  /// The entry of a class and a light.
  [[nodiscard]] const std::array<std::uint32_t, 3>& entry(std::uint32_t number, std::size_t light) const {
    return g.shares[(number - 1) * static_cast<std::size_t>(config.lights) + light];
  }
  /// Whether the entries of a class are these shares, to within the rounding.
  [[nodiscard]] bool entries_are(std::uint32_t number, const std::vector<glm::dvec3>& shares) const {
    for (std::size_t l = 0; l < samples.size(); ++l)
      for (int c = 0; c < 3; ++c)
        if (std::abs(entry(number, l)[static_cast<std::size_t>(c)] - shares[l][c] / samples[l] * 65536) > 0.51)
          return false;
    return true;
  }

  std::vector<Light> lights;
  Config config;
  Look look;
  Lighting lighting{lights, {0, 1, 0}};
  std::vector<int> samples;
  std::vector<Face> faces;
  FrameGeometry g;

  Tabled(const Tabled&) = delete;
  Tabled& operator=(const Tabled&) = delete;
};

}  // namespace

TEST_CASE("an entry is the mean by area over the faces of its class, however many classes became one") {
  Random random(test_seed());
  CAPTURE(test_seed());
  std::size_t merged = 0;
  for (int round = 0; round < 300; ++round) {
    CAPTURE(round);
    const bool directional = round % 2 == 0;
    const Tabled t(random, directional);
    std::map<std::uint32_t, std::vector<std::size_t>> of_class;
    for (std::size_t i = 0; i < t.faces.size(); ++i) of_class[t.g.polygons[i].normal_class].push_back(i);
    const std::size_t most = (std::size_t{1} << t.config.class_bits) - 1;
    REQUIRE(of_class.begin()->first == 1);
    REQUIRE(of_class.rbegin()->first == of_class.size());
    REQUIRE(of_class.size() <= most);
    REQUIRE(t.g.shares.size() == of_class.size() * static_cast<std::size_t>(t.config.lights));
    if (std::any_of(t.lights.begin(), t.lights.end(), [](const Light& l) { return !l.directional; })) {
      for (const auto& [number, members] : of_class) {
        std::vector<glm::dvec3> mean(t.lights.size(), glm::dvec3(0));
        double area = 0;
        for (const std::size_t i : members) {
          const Face& f = t.faces[i];
          const auto shares = t.lighting.shares(f.place, f.normal, f.lit, false);
          for (std::size_t l = 0; l < mean.size(); ++l) mean[l] += shares[l] * f.area;
          area += f.area;
        }
        for (glm::dvec3& m : mean) m /= area;
        CHECK(t.entries_are(number, mean));
      }
      continue;
    }
    // Entries of the class's own normal, and of all lights that reach one of its faces. The number of normals may
    // have been halved several times.
    bool right = false;
    for (int count = t.look.classes; !right; count /= 2) {
      const NormalClasses normals(std::max(count, 1));
      right = true;
      for (const auto& [number, members] : of_class) {
        std::bitset<kMaxLights> lit;
        for (const std::size_t i : members) lit |= t.faces[i].lit;
        bool some = false;
        for (int n = 1; n <= normals.count() && !some; ++n)
          some = t.entries_are(number, t.lighting.shares({}, normals.normal(n), lit, false));
        right = right && some;
      }
      merged += right && count != t.look.classes ? 1 : 0;
      if (count <= 1) break;
    }
    CHECK(right);
  }
  CAPTURE(merged);
  CHECK(merged > 20);
}

TEST_CASE("without table a face takes shadow where all samples of the light are before it") {
  SceneFrame f;
  add_solid(f, pane_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
  look_at(f.camera, {0.5, 0.5, 5}, {0, 0, 0});
  Light& l = f.lights[0];
  l.directional = false;
  l.shape = LightShape::disc;
  l.axis_u = {0, 0, 1};
  l.axis_v = {1, 0, 0};
  Config c;
  c.count_bits = 4;
  const auto lit = [&](double z) {
    l.position = {0, 0, z};
    const FrameGeometry g = make_geometry(f, c, 64, 48);
    REQUIRE(g.drawn > 0);
    return g.polygons[0].lit;
  };
  CHECK(lit(1.1));
  CHECK_FALSE(lit(0.5));  // some of its 15 samples are behind
  CHECK_FALSE(lit(-0.5));
  CHECK_FALSE(lit(-3));
}

}  // namespace kage::verif
