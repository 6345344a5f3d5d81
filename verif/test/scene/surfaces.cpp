// SPDX-License-Identifier: Apache-2.0
// Properties of materials besides colour: sides that are not to be seen, held against rays that pass them by, and
// surfaces that no light and no shadow touches, in every named configuration.
#include <map>

#include "geometry/shade.hpp"
#include "kage/config.hpp"
#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 48;
constexpr int kHeight = 36;

bool shows(Sides sides, bool from_outside) { return sides == Sides::both || (sides == Sides::front) == from_outside; }

/// Rays that pass faces by where they meet a side that is not to be seen. All faces keep out light.
class CulledRays {
 public:
  explicit CulledRays(const SceneFrame& f) : frame_(f), rays_(f) {}

  [[nodiscard]] std::pair<double, std::uint32_t> nearest(const glm::dvec3& origin, const glm::dvec3& direction,
                                                         double least) const {
    std::pair<double, std::uint32_t> found{INFINITY, kNothing};
    rays_.meet(origin, direction, [&](double t, std::uint32_t face) {
      const Triangle& corners = frame_.triangles[frame_.polygons[face].triangle];
      const glm::dvec3& p = frame_.vertices[corners.vertex[0]];
      const glm::dvec3 normal =
          glm::cross(frame_.vertices[corners.vertex[1]] - p, frame_.vertices[corners.vertex[2]] - p);
      if (t >= least && shows(corners.sides, glm::dot(normal, direction) < 0)) found = std::min(found, {t, face});
    });
    return found;
  }

  [[nodiscard]] bool blocked(const glm::dvec3& origin, const glm::dvec3& direction, double reach,
                             std::uint32_t own) const {
    return rays_.blocked(origin, direction, reach, own);
  }

 private:
  const SceneFrame& frame_;
  RayScene rays_;
};

/// Bodies, some open, each to be seen from one side or both.
SceneFrame sided_scene(Random& random) {
  SceneFrame f = random_scene(random, random.in(1, 6), random.chance(0.5));
  for (int i = 0; i < 2; ++i) {
    Solid open = box_solid();
    open.faces.resize(open.faces.size() - static_cast<std::size_t>(random.in(1, 6)));
    add_solid(f, open, {random.real(-2, 2), random.real(-1, 2), random.real(-2, 2)}, glm::dvec3(random.real(0.4, 1.2)),
              random_turn(random), {1, 1, 1}, false, false);
  }
  for (const Component& c : f.components) {
    const Sides sides = std::array{Sides::both, Sides::front, Sides::back}[static_cast<std::size_t>(random.in(0, 2))];
    for (std::uint32_t t = c.first; t < c.first + c.count; ++t) f.triangles[t].sides = sides;
  }
  return f;
}

}  // namespace

TEST_CASE("culled faces are not seen, and cast the shadows that rays say") {
  Random random(test_seed());
  CAPTURE(test_seed());
  Look look;
  look.cull = true;
  RayCount count;
  std::uint64_t changed = 0;
  for (int i = 0; i < 60; ++i) {
    Config config;
    config.dsf_bits = 1 + i % 3;
    config.units = i % 2 == 0 ? 0 : 2;
    CAPTURE(i);
    const SceneFrame f = sided_scene(random);
    const FrameGeometry g = make_geometry(f, config, kWidth, kHeight, {.look = look});
    Config spans = config;
    spans.units = 0;  // colours that stand for faces' numbers fit no unit's table
    count += compare_with_rays(f, g, spans, CulledRays(f));
    INFO(count.text());
    REQUIRE(count.good());
    changed += draw(g, spans) != draw(make_geometry(f, config, kWidth, kHeight), spans) ? 1 : 0;
  }
  INFO(count.text());
  CHECK(count.shadowed > 1000);
  CHECK(count.lit > 1000);
  CHECK(changed > 30);
  CHECK((count.near_surface + count.near_shadow) * 50 < count.pixels);
}

TEST_CASE("culled translucent faces are left out, and the others keep their order") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, -4}, {3, 3, 0.1}, Turn{}, {1, 1, 1});
  for (int i = 0; i < 3; ++i) add_glass(f, pane_solid(), {0, 0, i}, {1, 1, 1}, Turn{}, {1, 0, 0}, 100);
  look_at(f.camera, {0, 0, 6}, {0, 0, 0});
  Config config;
  config.translucency = 1;
  Look look;
  look.cull = true;
  const auto fragments = [&](Sides sides) {
    for (Triangle& t : f.triangles)
      if (t.alpha < 255 && t.vertex[0] >= f.vertices.size() - 4) t.sides = sides;  // of the last pane
    return make_geometry(f, config, kWidth, kHeight, {.look = look}).fragments.size();
  };
  CHECK(fragments(Sides::both) == 6);
  CHECK(fragments(Sides::front) == 6);
  CHECK(fragments(Sides::back) == 4);
}

TEST_CASE("no light and no shadow touches what is unlit, in any configuration; it casts all the same") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  std::uint64_t unlit_pixels = 0;
  std::uint64_t darkened = 0;
  Look look;
  look.darkening = 0.55;  // one that does not depend on which faces there are
  for (const NamedConfig& named : named_configs())
    for (int i = 0; i < 6; ++i) {
      const Config& config = named.config;
      INFO(named.name << " " << i);
      SceneFrame f = random_scene(random, 6);
      const FrameGeometry before = make_geometry(f, config, kWidth, kHeight, {.look = look});
      for (const Component& c : f.components) {
        const bool unlit = random.chance(0.5);
        for (std::uint32_t t = c.first; t < c.first + c.count; ++t) f.triangles[t].unlit = unlit;
      }
      FrameGeometry g = make_geometry(f, config, kWidth, kHeight, {.look = look});
      CHECK(g.volumes.size() == before.volumes.size());
      // Polyhedra come first, and what has one colour may be one: numbers change, faces do not.
      std::map<std::uint32_t, std::array<std::uint8_t, 3>> color_before;
      for (std::uint32_t k = 0; k < before.drawn; ++k)
        color_before[before.polygons[k].source] = before.polygons[k].color;
      for (std::uint32_t k = 0; k < g.drawn; ++k) {
        const Triangle& t = f.triangles[f.polygons[g.polygons[k].source].triangle];
        if (!t.unlit) {
          CHECK(g.polygons[k].color == color_before.at(g.polygons[k].source));
          continue;
        }
        CHECK_FALSE(g.polygons[k].lit);
        CHECK(g.polygons[k].normal_class == 0);
        CHECK(g.polygons[k].color_planes < 0);
        const glm::dvec3 base = Lighting::displayed_unlit(f.shading[t.shading[0]].color, config.channels == 1);
        for (unsigned c = 0; c < 3; ++c) CHECK(std::abs(g.polygons[k].color[c] - base[static_cast<int>(c)]) <= 0.5);
      }
      // Whatever shadows take, they take nothing from it.
      Config spans = config;
      spans.units = 0;
      if (spans.channels == 1) continue;  // pictures by face need 24 bits
      FrameGeometry numbered = g;
      numbered.background = kNothing;
      numbered.shade = 0;
      for (auto& share : numbered.shares) share = {0, 0, 0};
      const std::vector<std::uint32_t> plain = [&] {
        FrameGeometry bright = g;
        bright.shade = 0;
        for (auto& share : bright.shares) share = {0, 0, 0};
        if (!bright.passes.empty()) {  // light after light has no shares: without volumes no shadow takes anything
          bright.volumes.clear();
          bright.volume_faces.clear();
          bright.near_edges.clear();
        }
        return draw(bright, spans);
      }();
      Config numbers = spans;
      numbers.linear_bits = 0;  // whose curve would show other numbers
      numbered.passes.clear();
      for (std::uint32_t k = 0; k < numbered.drawn; ++k) {
        numbered.polygons[k].color_planes = numbered.polygons[k].light_planes = -1;
        numbered.polygons[k].shade_cut = -1;
        for (unsigned c = 0; c < 3; ++c) numbered.polygons[k].color[c] = static_cast<std::uint8_t>(k >> (8 * c));
      }
      const std::vector<std::uint32_t> seen = draw(numbered, numbers);
      const std::vector<std::uint32_t> picture = draw(g, spans);
      const std::vector<std::uint32_t> picture_before = draw(before, spans);
      for (std::size_t p = 0; p < picture.size(); ++p) {
        if (seen[p] == kNothing) continue;
        const bool unlit = f.triangles[f.polygons[g.polygons[seen[p]].source].triangle].unlit;
        unlit_pixels += unlit ? 1 : 0;
        darkened += picture[p] != plain[p] ? 1 : 0;
        if (unlit) CHECK(picture[p] == plain[p]);
        // A table's entries are means over the faces of a class, of which some have left.
        if (!unlit && config.class_bits == 1) CHECK(picture[p] == picture_before[p]);
      }
    }
  CHECK(unlit_pixels > 10000);
  CHECK(darkened > 300);
}

}  // namespace kage::verif
