// SPDX-License-Identifier: Apache-2.0
// Which polyhedron goes to which unit, against brute force: by cells of a small screen, and by the segments that a
// frame's layout writes.
#include "frontend/units.hpp"

#include <algorithm>

#include "extremes/screen.hpp"
#include "frontend/tree_layout.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"
#include "test/support/tree_frames.hpp"

namespace kage::verif {
namespace {

constexpr int kSide = 12;      // lines and columns of the small screen
constexpr int kPlenty = 1000;  // more than any case asks for

UnitRoom room(int units, int faces = kPlenty, int segments = kPlenty) { return {units, faces, segments, 7, kSide}; }

/// Rectangles of any size anywhere, as often as not one that is not to be seen.
std::vector<UnitNeed> random_needs(Random& random, int most) {
  std::vector<UnitNeed> needs(static_cast<std::size_t>(random.in(0, most)));
  const int longest = random.in(1, kSide);
  for (UnitNeed& n : needs) {
    if (random.chance(0.1)) {  // as a layout leaves it
      n.first = n.left = kSide;
      continue;
    }
    n.first = random.in(0, kSide - 1);
    n.end = std::min(kSide, n.first + random.in(1, longest));
    n.left = random.in(0, kSide - 1);
    n.right = std::min(kSide, n.left + random.in(1, longest));
    n.faces = random.in(1, 6);
    n.segments = random.in(1, 6);
  }
  return needs;
}

bool seen(const UnitNeed& n) { return n.end > n.first; }

/// Most polyhedra that lie on one line.
int most_on_a_line(std::span<const UnitNeed> needs) {
  int most = 0;
  for (int y = 0; y < kSide; ++y)
    most = std::max(most, static_cast<int>(std::count_if(needs.begin(), needs.end(), [y](const UnitNeed& n) {
                      return n.first <= y && y < n.end;
                    })));
  return most;
}

int units_used(std::span<const UnitNeed> needs, std::span<const int> units) {
  int used = 0;
  for (std::size_t i = 0; i < units.size(); ++i)
    if (seen(needs[i])) used = std::max(used, units[i] + 1);
  return used;
}

/// The fault of an assignment, found by painting every line and column of each unit; nothing if it is sound.
std::string fault(std::span<const UnitNeed> needs, std::span<const int> units, const UnitRoom& r) {
  std::vector<int> faces(static_cast<std::size_t>(r.units), 0);
  for (int u = 0; u < r.units; ++u)
    for (int y = 0; y < kSide; ++y) {
      std::array<int, kSide> owners{};
      int segments = 0;
      int members = 0;
      for (std::size_t i = 0; i < units.size(); ++i) {
        const UnitNeed& n = needs[i];
        if (units[i] != u || y < n.first || y >= n.end) continue;
        if (y == n.first) faces[static_cast<std::size_t>(u)] += n.faces;
        segments += n.segments;
        ++members;
        for (int x = n.left; x < n.right; ++x)
          if (++owners[static_cast<std::size_t>(x)] > 1) return "two of one unit meet";
      }
      // Blank ones: at least a run of nothing before, between and behind, where there is room for one, split by length.
      for (int x = 0; x < kSide;) {
        int end = x;
        while (end < kSide && owners[static_cast<std::size_t>(end)] == 0) ++end;
        segments += (end - x + r.max_dx - 1) / r.max_dx;
        x = end + 1;
      }
      if (members > 0 && segments > r.segments) return "more segments than a unit buffers";
    }
  for (std::size_t i = 0; i < units.size(); ++i)
    if (seen(needs[i]) && (units[i] < 0 || units[i] >= r.units)) return "no such unit";
  return std::any_of(faces.begin(), faces.end(), [&](int f) { return f > r.faces; }) ? "more faces than a table" : "";
}

}  // namespace

TEST_CASE("units: none of a unit meet, and faces and segments fit, whatever there is of them") {
  Random random(test_seed(1));
  CAPTURE(test_seed(1));
  std::array<int, 3> shared{};  // none placed, some, all
  for (int round = 0; round < 20'000; ++round) {
    const auto needs = random_needs(random, 12);
    const UnitRoom r = room(random.in(1, 6), random.chance(0.5) ? kPlenty : random.in(1, 12),
                            random.chance(0.5) ? kPlenty : random.in(3, 16));
    const std::vector<int> units = assign_units(needs, r);
    CAPTURE(round, needs.size(), units.size(), r.units, r.faces, r.segments);
    const std::string why = fault(needs, units, r);
    if (!why.empty()) FAIL(why);
    ++shared[needs.empty() || units.size() == needs.size() ? 2 : units.empty() ? 0 : 1];
    if (units != assign_units(needs, r)) FAIL("another outcome the second time");
    // In draw order up to the first that finds none: as if what follows were not there.
    const auto alone = assign_all(std::span(needs).first(units.size()), r);
    if (alone != units) FAIL("not what assign_all makes of these");
    if (units.size() < needs.size() && assign_all(std::span(needs).first(units.size() + 1), r))
      FAIL("one more would fit");
  }
  CAPTURE(shared);
  for (const int n : shared) CHECK(n > 1000);
}

TEST_CASE("units: where tables suffice, no more than polyhedra lie on one line; as many, where all meet in columns") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  int fewer = 0;
  for (int round = 0; round < 20'000; ++round) {
    auto needs = random_needs(random, 14);
    const bool columns = random.chance(0.5);
    if (columns)
      for (UnitNeed& n : needs)
        if (seen(n)) n.left = 0, n.right = kSide;
    const int most = most_on_a_line(needs);
    CAPTURE(round, needs.size(), most, columns);
    const auto units = assign_all(needs, room(64));
    REQUIRE(units);
    const int used = units_used(needs, *units);
    if (used > most) FAIL("more units than the bound");
    if (columns && used < most) FAIL("two that meet are in one unit");
    fewer += used < most ? 1 : 0;
    // So many units suffice, and the assignment is the same: a unit that is not needed is not taken.
    if (most > 0 && assign_all(needs, room(used)) != units) FAIL("depends on units that are not used");
    if (used > 0 && assign_all(needs, room(used - 1))) FAIL("one less would do");
  }
  CHECK(fewer > 1000);  // columns that do not meet are of use
}

TEST_CASE("units: one that no unit can hold, and all behind it, go without, though others would fit") {
  const UnitNeed small{0, 3, 0, 3, 2, 3};
  UnitNeed large = small;
  large.faces = 9;
  std::vector<UnitNeed> needs{small, large, small};
  needs[2].left = 5;
  needs[2].right = 8;
  CHECK(assign_units(needs, room(4, 8)) == std::vector<int>{0});
  needs[1].faces = 4;  // with the first it fits, but meets it; the third shares with either
  CHECK(assign_units(needs, room(4, 8)) == std::vector<int>{0, 1, 0});
  CHECK(assign_units(needs, room(4, 5)) == std::vector<int>{0, 1, 0});
  CHECK(assign_units(needs, room(4, 4)) == std::vector<int>{0, 1, 0});
  needs[2].faces = 3;
  CHECK(assign_units(needs, room(4, 4)) == std::vector<int>{0, 1, 2});
  CHECK(assign_units(needs, room(2, 4)) == std::vector<int>{0, 1});
  CHECK(assign_units({}, room(1)).empty());
}

TEST_CASE("units: a layout's needs are what its runs ask for, and its segments on a line never exceed the bound") {
  constexpr int kWidth = 96;
  constexpr int kHeight = 72;
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  int layouts = 0;
  int shared = 0;
  int exact = 0;
  for (int round = 0; round < 150; ++round) {
    Config c;
    c.units = random.in(1, 8);
    c.dx_bits = random.in(3, 7);
    c.seg_bits = random.in(4, 7);
    const FrameGeometry g = make_geometry(random_scene(random, random.in(1, 12), true), c, kWidth, kHeight);
    const int longest = (1 << c.dx_bits) - 1;
    // Needs pixel by pixel.
    std::vector<UnitNeed> needs(g.polyhedra.size());
    PolyhedronScanner scanner(g, c);
    for (std::size_t i = 0; i < needs.size(); ++i) {
      UnitNeed& n = needs[i];
      n.first = n.left = kWidth;
      scanner.scan(g.polyhedra[i], 0, kHeight, [&](int y, std::span<const Run> runs) {
        std::array<std::uint32_t, kWidth> face{};
        for (const Run& r : runs)
          for (int x = r.xl; x < r.xr; ++x) face[static_cast<std::size_t>(x)] = r.polygon + 1;
        int segments = 0;
        int length = 0;
        for (int x = runs.front().xl; x < runs.back().xr; ++x) {
          const auto at = static_cast<std::size_t>(x);
          const bool next = x == runs.front().xl || face[at] != face[at - 1] || length == longest;
          length = next ? 1 : length + 1;
          segments += next ? 1 : 0;
        }
        n.first = std::min(n.first, y);
        n.end = y + 1;
        n.left = std::min(n.left, runs.front().xl);
        n.right = std::max(n.right, runs.back().xr);
        n.segments = std::max(n.segments, segments);
      });
      if (n.end > 0) n.faces = static_cast<int>(g.polyhedra[i].polygon_count);
    }
    const UnitRoom r{c.units, (1 << c.face_bits) - 1, 1 << c.seg_bits, longest, kWidth};
    std::vector<int> units = assign_units(needs, r);
    const auto bound_of = [&](const std::vector<UnitNeed>& members) {
      UnitRoom one = r;
      one.units = 1;
      for (one.segments = 0; !assign_all(members, one); ++one.segments) {
      }
      return one.segments;
    };
    const Picture p = picture(g, c);
    CAPTURE(round, c.units, c.dx_bits, c.seg_bits);
    for (std::size_t i = 0; i < needs.size(); ++i) {
      const int expected = i >= units.size()   ? PolyhedraReport::kSpans
                           : needs[i].end == 0 ? PolyhedraReport::kUnseen
                                               : units[i];
      CHECK(p.report.unit_of[i] == expected);
    }
    if (p.count(Kind::TREE) == 0) continue;
    ++layouts;
    const auto lines = segments_of(p, c);
    for (int u = 0; u < c.units; ++u) {
      std::vector<UnitNeed> members;
      for (std::size_t i = 0; i < units.size(); ++i)
        if (units[i] == u && needs[i].end > 0) members.push_back(needs[i]);
      if (members.empty()) continue;
      std::size_t most = 0;
      for (const auto& line : lines[static_cast<std::size_t>(u)]) most = std::max(most, line.size());
      const int bound = bound_of(members);
      CHECK(static_cast<int>(most) <= bound);
      CHECK(bound <= r.segments);
      shared += members.size() > 1 ? 1 : 0;
      // Alone in its unit: too much by no more than a blank one at each side and what length can ask for.
      if (members.size() > 1) continue;
      CHECK(bound - static_cast<int>(most) <= 2 + kWidth / longest);
      exact += bound - static_cast<int>(most) <= 1 ? 1 : 0;
    }
  }
  CAPTURE(layouts, shared, exact);
  CHECK(layouts > 100);
  CHECK(shared > 50);
  CHECK(exact > 10);
}

TEST_CASE("units: blank segments between faces of one body count") {
  // Eight faces apart from each other, as a body's faces may lie where the snap has turned those between away: on a
  // line 8 runs, 7 gaps, and one of nothing at each side.
  constexpr int kFaces = 8;
  FrameBuilder b(96, 4);
  for (int i = 0; i < kFaces; ++i) b.add(rectangle(4 + 11 * i, 0, 9 + 11 * i, 4), plane(1000), {1, 2, 3});
  FrameGeometry& g = b.frame();
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    const auto outline = g.outline(g.polygons[i]);
    for (std::size_t k = 0; k < 4; ++k)
      g.polyhedron_edges.push_back({outline[k], outline[(k + 1) % 4], i, PolyhedronEdge::kNoPolygon});
  }
  g.polyhedra.push_back({0, 0, kFaces, 0, 4 * kFaces});
  for (const int seg_bits : {4, 5}) {
    Config c;
    c.units = 1;
    c.dx_bits = 4;
    c.seg_bits = seg_bits;
    const SegmentCount n = count_segments(picture(g, c), g, c);
    CHECK(n.by_segments == (seg_bits == 5 ? 1 : 0));
    CHECK(n.most == (seg_bits == 5 ? 17 : 0));
  }
}

}  // namespace kage::verif
