// SPDX-License-Identifier: Apache-2.0
// Families 31 - 34: polyhedra by segments and the compare tree, held bit by bit against the same polyhedra by spans.
#include <algorithm>

#include "oracle/judge.hpp"
#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"
#include "test/support/tree_frames.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 72;

using Counts = std::array<SegmentCount, kUnitCounts.size()>;

Counts either_way(const SceneFrame& f, const Config& config = {}) {
  return same_either_way(f, config, kWidth, kHeight);
}

Config with_units(int units) {
  Config c;
  c.units = units;
  return c;
}

/// A view in which a unit is a pixel: (x, y, z) is seen at pixel (48 + x, 36 - y).
void pixel_view(SceneFrame& f) {
  look_at(f.camera, {0, 0, 100}, {0, 0, 0});
  f.camera.perspective = false;
  f.camera.half_height = kHeight / 2.0;
}

/// A body that shows at pixels [x0, x1) x [y0, y1) its front, and right of it, down to `side` pixels further, a face
/// that leads to its back.
Solid block(double x0, double x1, double y0, double y1, double side = 0) {
  Solid s = box_solid();
  for (glm::dvec3& v : s.vertices)
    v = {(v.x < 0 ? x0 : v.z < 0 ? x1 + side : x1) - kWidth / 2.0, kHeight / 2.0 - (v.y < 0 ? y1 : y0), v.z};
  return s;
}

}  // namespace

TEST_CASE("family 33: random polyhedra give the same bits by segments and by spans, with any number of units") {
  Random random(test_seed(31));
  CAPTURE(test_seed(31));
  std::array<int, kUnitCounts.size()> by_segments{};
  std::uint64_t segments = 0;
  int by_spans = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const Counts counts = either_way(random_scene(random, random.in(1, 12), true));
    for (std::size_t n = 0; n < counts.size(); ++n) by_segments[n] += counts[n].by_segments;
    // With 64 units there is one for each polyhedron that covers a pixel; fewer serve some.
    CHECK(counts.back().by_spans == 0);
    CHECK(counts.back().units_used <= counts.back().by_segments);
    segments += counts.back().of_faces;
    by_spans += counts.front().by_spans;
  }
  CAPTURE(by_segments);
  CHECK(std::is_sorted(by_segments.begin(), by_segments.end()));
  CHECK(by_segments.front() > 60);
  CHECK(by_spans > 100);
  CHECK(segments > 5'000);
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
    // All of the picture is the first one's.
    SceneFrame first = f;
    first.polygons.resize(first.components[0].polygon_count);
    first.triangles.resize(first.components[0].count);
    first.components.resize(1);
    const Config c = with_units(8);
    CHECK(picture(make_geometry(f, c, kWidth, kHeight), c).pixels ==
          picture(make_geometry(first, c, kWidth, kHeight), c).pixels);
    // They meet everywhere: each has a unit of its own, and the ties are between units, or units and spans.
    for (const SegmentCount& n : either_way(f)) {
      CHECK(n.by_segments == std::min(n.units, 5));
      CHECK(n.units_used == n.by_segments);
      CHECK(n.by_spans == 5 - n.by_segments);
    }
  }
}

TEST_CASE("family 31: edges on lines, edge-on faces, one-pixel faces, bodies leaving the screen by exact pixels") {
  struct Case {
    const char* what;
    Solid solid;
    std::uint64_t segments, pixels;  // that show it
  };
  const std::vector<Case> cases{
      {"edges on the lines' and the pixels' centres: the upper and left ones count", block(10.5, 20.5, 5.5, 15.5), 10,
       100},
      {"edges between the pixels", block(10, 20, 5, 15), 10, 100},
      {"a subpixel below and right of the centres", block(10 + 129 / 256.0, 20.5, 5 + 129 / 256.0, 15.5), 9, 81},
      {"one pixel", block(30, 31, 40, 41), 1, 1},
      {"two subpixels round a pixel's centre",
       block(30 + 127 / 256.0, 30 + 129 / 256.0, 40 + 127 / 256.0, 40 + 129 / 256.0), 1, 1},
      {"nothing, between centres", block(30 + 129 / 256.0, 31 + 127 / 256.0, 40, 50), 0, 0},
      {"a face of one pixel beside one of ten", block(30, 40, 40, 41, 1), 2, 11},
      {"a face of one column", block(30, 40, 40, 45, 1), 10, 55},
      {"leaving on the left", block(-10, 10, 20, 30), 10, 100},
      {"leaving on the right", block(kWidth - 10, kWidth + 10, 20, 30), 10, 100},
      {"leaving above", block(20, 30, -10, 10), 10, 100},
      {"leaving below", block(20, 30, kHeight - 10, kHeight + 10), 10, 100},
      {"leaving at a corner", block(kWidth - 10, kWidth + 10, -10, 10), 10, 100},
      {"leaving on all sides", block(-10, kWidth + 10, -10, kHeight + 10), kHeight, std::uint64_t{kWidth} * kHeight},
      {"touching the left edge from outside", block(-10, 0, 20, 30), 0, 0},
      {"touching the lower edge from outside", block(20, 30, kHeight, kHeight + 10), 0, 0},
  };
  for (const Case& c : cases) {
    CAPTURE(c.what);
    SceneFrame f;
    add_solid(f, c.solid, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
    pixel_view(f);
    const FrameGeometry g = make_geometry(f, with_units(1), kWidth, kHeight);
    REQUIRE(g.polyhedra.size() == 1);
    // In this view a block's upper and lower sides are edge-on, so two vertices of each front edge lie on one line.
    CHECK(std::count_if(g.polyhedron_edges.begin(), g.polyhedron_edges.end(),
                        [](const PolyhedronEdge& e) { return e.from.y == e.to.y; }) >= 2);
    for (const SegmentCount& n : either_way(f)) {
      CHECK(n.of_faces == c.segments);
      CHECK(n.face_pixels == c.pixels);
      CHECK(n.unseen == (c.pixels == 0 ? 1 : 0));
      CHECK(n.by_spans == 0);
    }
  }
}

TEST_CASE(
    "family 31: bodies turned anyhow, within the screen, across its sides and outside; specks on centres and off") {
  Random random(test_seed(32));
  CAPTURE(test_seed(32));
  // Four before the eye a pixel is 1/18: the screen reaches 8/3 to the sides and 2 up and down.
  const double half = 0.5 / 18;
  const auto view = [&](const Solid& solid, const glm::dvec3& centre, double size, bool turned) {
    SceneFrame f;
    add_solid(f, solid, centre, glm::dvec3(size), turned ? random_turn(random) : Turn{}, {1, 0.5, 0.2});
    look_at(f.camera, {0, 0, 4}, {0, 0, 0});
    return f;
  };
  for (const Solid& solid : {box_solid(), tetrahedron_solid(), octahedron_solid()})
    for (const bool turned : {false, true}) {
      CAPTURE(turned);
      for (const int right : {-1, 0, 1})
        for (const int down : {-1, 0, 1}) {
          CAPTURE(right, down);
          const SceneFrame f = view(solid, {right * 8 / 3.0, -down * 2.0, 0}, 1, turned);
          for (const SegmentCount& n : either_way(f)) CHECK(n.by_segments == 1);
          const FrameGeometry g = make_geometry(f, Config{}, kWidth, kHeight);
          const auto crosses = [&](std::int32_t at, std::int32_t ScreenVertex::*axis) {
            bool before = false;
            bool after = false;
            for (const PolyhedronEdge& e : g.polyhedron_edges) {
              before = before || e.from.*axis < at || e.to.*axis < at;
              after = after || e.from.*axis > at || e.to.*axis > at;
            }
            return before && after;
          };
          CHECK(crosses(0, &ScreenVertex::x) == (right < 0));
          CHECK(crosses(256 * kWidth, &ScreenVertex::x) == (right > 0));
          CHECK(crosses(0, &ScreenVertex::y) == (down < 0));
          CHECK(crosses(256 * kHeight, &ScreenVertex::y) == (down > 0));
        }
      for (const SegmentCount& n : either_way(view(solid, {30, 0, 0}, 1, turned))) CHECK(n.unseen == 1);
      // A few subpixels large: one pixel if it lies on a centre, else none.
      for (const double size : {0.004, 0.001})
        for (const int x : {-50, 0, 3, 47, 48})
          for (const bool on : {true, false}) {
            CAPTURE(size, x, on);
            const glm::dvec3 centre((2 * x + (on ? 1 : 0)) * half, (on ? 1 : 0) * half, 0);
            const bool seen = on && x >= -kWidth / 2 && x < kWidth / 2;
            for (const SegmentCount& n : either_way(view(solid, centre, size, turned))) {
              CHECK(n.face_pixels == (seen ? 1 : 0));
              CHECK(n.unseen == (seen ? 0 : 1));
            }
          }
    }
}

TEST_CASE("family 32: runs longer than a segment are split, whatever the length of one") {
  for (const bool whole_lines : {false, true}) {
    SceneFrame f;
    add_solid(f, box_solid(), {0, 0, 0}, {whole_lines ? 100 : 3, 1, 1}, Turn{}, {1, 0.5, 0.2});
    look_at(f.camera, {whole_lines ? 0.01 : 0.3, 0.2, 3}, {0, 0, 0});
    for (const int width : {511, 512, 513, 1023})
      for (const int dx_bits : {2, 5, 9, 11}) {
        CAPTURE(whole_lines, width, dx_bits);
        Config c;
        c.max_width = 2047;
        c.dx_bits = dx_bits;
        c.seg_bits = 10;
        const FrameGeometry g = make_geometry(f, c, width, 24);
        const RunCount runs = count_runs(g, c);
        const int longest = (1 << dx_bits) - 1;
        CHECK((runs.longest == width) == whole_lines);
        for (const SegmentCount& n : same_either_way(f, c, width, 24)) {
          CHECK(n.by_segments == 1);
          // Split if and only if a run is longer than a segment.
          CHECK((n.of_faces > runs.runs) == (runs.longest > longest));
          CHECK(n.of_faces >= runs.runs);
          if (whole_lines) CHECK(n.longest == std::min(longest, width));
          // A unit without polyhedra has blank lines, split likewise; a front that fills the line takes as many.
          if (whole_lines || n.units > 1) CHECK(n.most >= static_cast<std::size_t>((width + longest - 1) / longest));
        }
        // No picture shows a fraction of an LSB: the next segment goes on with the very sum that the run has reached.
        c.units = 1;
        const Picture p = picture(g, c);
        std::vector<std::int64_t> steps;  // of the faces
        each_token(p.words, c, Kind::FACE, [&](const Token& t, std::size_t) { steps.push_back(t.segment.dz); });
        std::uint64_t joints = 0;
        std::uint64_t wrong = 0;
        const auto units = segments_of(p, c);
        for (const auto& line : units[0])
          for (std::size_t i = 1; i < line.size(); ++i) {
            const SegmentToken& s = line[i - 1];
            if (line[i].face != s.face || s.face == (1 << c.face_bits) - 1) continue;
            ++joints;
            wrong += line[i].z != s.z + s.dx * steps.at(static_cast<std::size_t>(s.face)) ? 1 : 0;
          }
        CHECK((joints > 0) == (runs.longest > longest));
        CHECK(wrong == 0);
      }
  }
}

TEST_CASE("family 32: as many faces as a table holds, and one more") {
  // A box shows three faces here; FACE_BITS = 2 holds three.
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(f.camera, {2, 2, 3}, {0, 0, 0});
  Config c;
  c.face_bits = 2;
  const FrameGeometry g = make_geometry(f, c, kWidth, kHeight);
  REQUIRE(g.polyhedra.size() == 1);
  REQUIRE(g.polyhedra[0].polygon_count == 3);
  for (const SegmentCount& n : either_way(f, c)) CHECK(n.by_segments == 1);
  // An octahedron shows four: it goes the span way, however many units there are.
  SceneFrame more;
  add_solid(more, octahedron_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(more.camera, {0.3, 0.2, 3}, {0, 0, 0});
  REQUIRE(make_geometry(more, c, kWidth, kHeight).polyhedra[0].polygon_count == 4);
  for (const SegmentCount& n : either_way(more, c)) CHECK(n.by_spans == 1);
}

TEST_CASE("family 32: as many segments as a unit buffers, and one more") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(f.camera, {2, 2, 3}, {0, 0, 0});
  bool before = false;
  std::size_t most = 0;
  for (int seg_bits = 2; seg_bits <= 8; ++seg_bits) {
    CAPTURE(seg_bits);
    Config c;
    c.seg_bits = seg_bits;
    c.dx_bits = 4;
    const Counts counts = either_way(f, c);
    const bool now = counts.front().by_segments == 1;
    for (const SegmentCount& n : counts) CHECK((n.by_segments == 1) == now);
    // From some size on: the first that takes it holds its longest line, the one before holds less than the bound.
    CHECK(now >= before);
    if (now && !before) most = counts.front().most;
    if (now) CHECK(counts.front().most == most);
    if (seg_bits == 2) CHECK_FALSE(now);
    before = now;
  }
  CHECK(before);
  // Three runs of faces and two of nothing, split by 15: more than the smallest buffer, and not a large one full.
  CHECK(most > 4);
  CHECK(most <= 16);
}

TEST_CASE("family 34: polyhedra that never meet share a unit; those that do not fit become spans, in draw order") {
  // Nine boxes side by side and below each other need one unit; nine in front of each other need nine.
  for (const bool apart : {true, false}) {
    SceneFrame f;
    for (int i = 0; i < 9; ++i)
      add_solid(f, box_solid(), apart ? glm::dvec3(i % 3 - 1, i / 3 - 1, 0) * 1.2 : glm::dvec3(0, 0, -0.2 * i),
                glm::dvec3(0.3), Turn{}, {1, 0.1 * i, 0.2});
    look_at(f.camera, {0, 0, 6}, {0, 0, 0});
    for (const SegmentCount& n : either_way(f)) {
      CAPTURE(apart, n.units);
      CHECK(n.units_used == (apart ? 1 : std::min(n.units, 9)));
      CHECK(n.by_segments == (apart ? 9 : std::min(n.units, 9)));
      const Config c = with_units(n.units);
      const Picture p = picture(make_geometry(f, c, kWidth, kHeight), c);
      for (int i = 0; i < 9; ++i) CHECK((p.report.unit_of[static_cast<std::size_t>(i)] >= 0) == (apart || i < n.units));
    }
  }
}

TEST_CASE("family 34: polyhedra past those that ORDER_BITS can number become spans, however many units there are") {
  SceneFrame f;
  for (int i = 0; i < 9; ++i) add_solid(f, box_solid(), {0, 0, -0.2 * i}, glm::dvec3(0.3), Turn{}, {1, 0.1 * i, 0.2});
  look_at(f.camera, {0, 0, 6}, {0, 0, 0});
  for (const int order_bits : {1, 3, 4}) {
    CAPTURE(order_bits);
    Config c;
    c.order_bits = order_bits;
    for (const SegmentCount& n : either_way(f, c)) CHECK(n.by_segments == std::min({n.units, 1 << order_bits, 9}));
    c.units = 9;
    CHECK((picture(make_geometry(f, c, kWidth, kHeight), c).report.stop == PolyhedraReport::Stop::index) ==
          (order_bits < 4));
  }
}

TEST_CASE("polyhedra by segments are what the oracle and rays say") {
  Random random(test_seed(35));
  CAPTURE(test_seed(35));
  int by_segments = 0;
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_scene(random, random.in(1, 8), true);
    const Config c = with_units(8);
    const FrameGeometry g = make_geometry(f, c, kWidth, kHeight);
    by_segments += picture(g, c).by_segments();
    const Judgement j = judge(g, c);
    INFO(j.text());
    CHECK(j.good());
    const RayCount rays = compare_with_rays(f, g, c);
    INFO(rays.text());
    CHECK(rays.good());
  }
  CHECK(by_segments > 40);
}

}  // namespace kage::verif
