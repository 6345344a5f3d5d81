// SPDX-License-Identifier: Apache-2.0
// Families 31 - 34: polyhedra by segments and the compare tree, held bit by bit against the same polyhedra by spans.
#include <algorithm>

#include "catch.hpp"
#include "scene/judge.hpp"
#include "scene/ray_truth.hpp"
#include "support/shapes.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 72;

Config with_units(int units) {
  Config c;
  c.units = units;
  return c;
}

struct Picture {
  std::vector<std::uint32_t> pixels;
  TokenCounts counts;
  PolyhedraReport report;
};

Picture picture(const FrameGeometry& g, const Config& config) {
  Picture p;
  std::vector<std::uint32_t> words;
  make_frame(
      g, config, 0, [&](std::span<const std::uint32_t> w) { words.insert(words.end(), w.begin(), w.end()); }, 1,
      &p.report);
  p.counts = check_frame(config, words, "front end", 0);
  GoldenCore core(config);
  const FrameStatus status = core.frame(words, [&](int, std::span<const std::uint8_t> line) {
    for (std::size_t i = 0; i < line.size(); i += static_cast<std::size_t>(config.channels))
      p.pixels.push_back(config.channels == 1 ? line[i]
                                              : line[i] | static_cast<std::uint32_t>(line[i + 1]) << 8 |
                                                    static_cast<std::uint32_t>(line[i + 2]) << 16);
  });
  REQUIRE(status.error == ErrorCode::NONE);
  return p;
}

std::uint64_t count(const Picture& p, Kind kind) { return p.counts.of_kind[static_cast<std::size_t>(kind)]; }

/// The same frame by spans and with 1, 2, 3, 4, 5, 8, 9 and 64 units.
void same_either_way(const SceneFrame& f, Config config = {}, int width = kWidth, int height = kHeight) {
  config.units = 0;
  const Picture spans = picture(make_geometry(f, config, width, height), config);
  for (const int units : {1, 2, 3, 4, 5, 8, 9, 64}) {
    CAPTURE(units);
    config.units = units;
    const Picture tree = picture(make_geometry(f, config, width, height), config);
    CHECK(std::equal(tree.pixels.begin(), tree.pixels.end(), spans.pixels.begin(), spans.pixels.end()));
  }
}

}  // namespace

TEST_CASE("family 33: random polyhedra give the same bits by segments and by spans, with any number of units") {
  Random random(test_seed(31));
  CAPTURE(test_seed(31));
  std::uint64_t segments = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_scene(random, random.in(1, 12), true);
    same_either_way(f);
    segments += count(picture(make_geometry(f, with_units(64), kWidth, kHeight), with_units(64)), Kind::SEG);
  }
  CHECK(segments > 10'000);
}

TEST_CASE("family 33: equal depth from two polyhedra goes to the lower draw index, whichever units they are in") {
  Random random(test_seed(33));
  CAPTURE(test_seed(33));
  for (int i = 0; i < 10; ++i) {
    CAPTURE(i);
    // The same body several times, in different colours: all depths are equal.
    SceneFrame f;
    const Turn turn = random_turn(random);
    for (int k = 0; k < 5; ++k)
      add_solid(f, octahedron_solid(), {0, 0, 0}, {1, 1, 1}, turn,
                {random.real(0, 1), random.real(0, 1), random.real(0, 1)});
    look_at(f.camera, {0, 0, 3}, {0, 0, 0});
    same_either_way(f);
    // All of the picture is the first one's.
    SceneFrame first = f;
    first.polygons.resize(first.components[0].polygon_count);
    first.triangles.resize(first.components[0].count);
    first.components.resize(1);
    const Config c = with_units(8);
    CHECK(picture(make_geometry(f, c, kWidth, kHeight), c).pixels ==
          picture(make_geometry(first, c, kWidth, kHeight), c).pixels);
  }
}

TEST_CASE("family 31: edges on lines, edge-on faces, one-pixel faces, bodies leaving the screen on each side") {
  Random random(test_seed(32));
  CAPTURE(test_seed(32));
  const std::array<Solid, 3> solids{box_solid(), tetrahedron_solid(), octahedron_solid()};
  for (const glm::dvec3& centre :
       {glm::dvec3{0, 0, 0}, {2.2, 0, 0}, {-2.2, 0, 0}, {0, 1.7, 0}, {0, -1.7, 0}, {2.2, 1.7, 0}, {30, 0, 0}})
    for (const double size : {1.0, 0.01, 0.001})
      for (const Solid& solid : solids)
        for (const bool turned : {false, true}) {
          SceneFrame f;
          add_solid(f, solid, centre, glm::dvec3(size), turned ? random_turn(random) : Turn{}, {1, 0.5, 0.2});
          look_at(f.camera, {0, 0, 4}, {0, 0, 0});
          same_either_way(f);
        }
}

TEST_CASE("family 32: runs longer than a segment are split, whatever the length of one") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, 0}, {3, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(f.camera, {0.3, 0.2, 3}, {0, 0, 0});
  for (const int width : {511, 512, 513, 1023})
    for (const int dx_bits : {2, 5, 9, 11}) {
      CAPTURE(width, dx_bits);
      Config c;
      c.max_width = 2047;
      c.dx_bits = dx_bits;
      c.seg_bits = 10;
      same_either_way(f, c, width, 24);
    }
}

TEST_CASE("family 32: as many faces as a table holds, and one more") {
  // A box shows three faces here; FACE_BITS = 2 holds three.
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(f.camera, {2, 2, 3}, {0, 0, 0});
  Config c = with_units(1);
  c.face_bits = 2;
  const FrameGeometry g = make_geometry(f, c, kWidth, kHeight);
  REQUIRE(g.polyhedra.size() == 1);
  REQUIRE(g.polyhedra[0].polygon_count == 3);
  CHECK(picture(g, c).report.unit_of[0] == 0);
  // An octahedron shows four: it goes the span way.
  SceneFrame more;
  add_solid(more, octahedron_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(more.camera, {0.3, 0.2, 3}, {0, 0, 0});
  const FrameGeometry four = make_geometry(more, c, kWidth, kHeight);
  REQUIRE(four.polyhedra[0].polygon_count == 4);
  const Picture spans = picture(four, c);
  CHECK(spans.report.unit_of[0] == -1);
  CHECK(count(spans, Kind::SEG) == 0);
  same_either_way(more, c);
}

TEST_CASE("family 32: as many segments as a unit buffers, and one more") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(f.camera, {2, 2, 3}, {0, 0, 0});
  bool by_segments = false;
  bool by_spans = false;
  for (int seg_bits = 2; seg_bits <= 8; ++seg_bits) {
    CAPTURE(seg_bits);
    Config c = with_units(1);
    c.seg_bits = seg_bits;
    c.dx_bits = 4;
    const Picture p = picture(make_geometry(f, c, kWidth, kHeight), c);
    (p.report.unit_of[0] == 0 ? by_segments : by_spans) = true;
    same_either_way(f, c);
  }
  CHECK(by_segments);
  CHECK(by_spans);
}

TEST_CASE("family 34: polyhedra that never meet share a unit; those that do not fit become spans, in draw order") {
  // Nine boxes side by side and below each other need one unit; nine in front of each other need nine.
  for (const bool apart : {true, false}) {
    SceneFrame f;
    for (int i = 0; i < 9; ++i)
      add_solid(f, box_solid(), apart ? glm::dvec3(i % 3 - 1, i / 3 - 1, 0) * 1.2 : glm::dvec3(0, 0, -0.2 * i),
                glm::dvec3(0.3), Turn{}, {1, 0.1 * i, 0.2});
    look_at(f.camera, {0, 0, 6}, {0, 0, 0});
    for (const int units : {1, 4, 9, 16}) {
      CAPTURE(apart, units);
      const Config c = with_units(units);
      const Picture p = picture(make_geometry(f, c, kWidth, kHeight), c);
      CHECK(p.report.units == (apart ? 1 : std::min(units, 9)));
      for (int i = 0; i < 9; ++i) CHECK((p.report.unit_of[static_cast<std::size_t>(i)] >= 0) == (apart || i < units));
    }
    same_either_way(f);
  }
}

TEST_CASE("the paper's format gives the same bits by segments and by spans") {
  Random random(test_seed(34));
  CAPTURE(test_seed(34));
  Config c;
  c.classic = 1;
  c.z_bits = 15;
  c.z_frac = 0;
  std::uint64_t segments = 0;
  for (int i = 0; i < 30; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_scene(random, random.in(1, 8), true);
    same_either_way(f, c);
    Config units = c;
    units.units = 8;
    segments += count(picture(make_geometry(f, units, kWidth, kHeight), units), Kind::SEG);
  }
  CHECK(segments > 1000);
}

TEST_CASE("the paper's format: a split run whose sum leaves 15 bits makes spans, not an error") {
  // Long thin walls, nearly facing the eye, as deep as the scene: the step is a small fraction that rounds badly.
  Config c;
  c.classic = 1;
  c.z_bits = 15;
  c.z_frac = 0;
  bool by_segments = false;
  bool by_spans = false;
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const double a = (i % 2 == 0 ? -1 : 1) * (0.012 + 0.0001 * i);
    SceneFrame f;
    add_solid(f, box_solid(), {0, 0, 0}, {7.5, 0.3, 0.0001},
              Turn{{std::cos(a), 0, -std::sin(a)}, {0, 1, 0}, {std::sin(a), 0, std::cos(a)}}, {1, 0.6, 0.2});
    look_at(f.camera, {0, 0, 20}, {0, 0, 0});
    f.camera.perspective = false;
    f.camera.half_height = 0.6;
    same_either_way(f, c, 640, 48);
    Config units = c;
    units.units = 2;
    const Picture p = picture(make_geometry(f, units, 640, 48), units);
    (count(p, Kind::SEG) > 0 ? by_segments : by_spans) = true;
  }
  CHECK(by_segments);
  CHECK(by_spans);
}

TEST_CASE("polyhedra by segments are what the oracle and rays say") {
  Random random(test_seed(35));
  CAPTURE(test_seed(35));
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_scene(random, random.in(1, 8), true);
    const Config c = with_units(8);
    const Judgement j = judge(make_geometry(f, c, kWidth, kHeight), c);
    INFO(j.text());
    CHECK(j.good());
    const RayCount rays = compare_with_rays(f, make_geometry(f, c, kWidth, kHeight), c);
    INFO(rays.text());
    CHECK(rays.good());
  }
}

}  // namespace kage::verif
