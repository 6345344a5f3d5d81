// SPDX-License-Identifier: Apache-2.0
// Triangles of a fan that fan_corner() chose, against points in outline and triangles by winding numbers.
#include "geometry/fan.hpp"

#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "test/support/catch.hpp"

using kage::fan_corner;
using kage::ScreenVertex;

namespace {

/// How often the outline goes round a point that lies on none of its sides; the point in halves of the corners' unit.
int winding(const std::vector<ScreenVertex>& outline, std::int64_t x2, std::int64_t y2) {
  int turns = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ScreenVertex& a = outline[i];
    const ScreenVertex& b = outline[(i + 1) % outline.size()];
    const bool down = 2 * std::int64_t{a.y} <= y2 && 2 * std::int64_t{b.y} > y2;
    const bool up = 2 * std::int64_t{b.y} <= y2 && 2 * std::int64_t{a.y} > y2;
    if (!down && !up) continue;
    // The side crosses the point's line to the right of it: x2 < ax + (bx - ax) (y2 - ay) / (by - ay).
    const std::int64_t dy = 2 * (std::int64_t{b.y} - a.y);
    const std::int64_t gap =
        (x2 - 2 * std::int64_t{a.x}) * dy - 2 * (std::int64_t{b.x} - a.x) * (y2 - 2 * std::int64_t{a.y});
    if (dy > 0 ? gap < 0 : gap > 0) turns += down ? 1 : -1;
  }
  return turns;
}

bool on_a_side(const std::vector<ScreenVertex>& outline, std::int64_t x2, std::int64_t y2) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ScreenVertex& a = outline[i];
    const ScreenVertex& b = outline[(i + 1) % outline.size()];
    if ((2 * std::int64_t{b.x} - 2 * std::int64_t{a.x}) * (y2 - 2 * std::int64_t{a.y}) ==
        (2 * std::int64_t{b.y} - 2 * std::int64_t{a.y}) * (x2 - 2 * std::int64_t{a.x}))
      return true;  // on the line of the side, which is more than needed
  }
  return false;
}

}  // namespace

TEST_CASE("fan_corner: a convex outline is cut from its first corner, a bent one from a corner that sees all of it") {
  CHECK(fan_corner(std::vector<ScreenVertex>{{0, 0}, {8, 0}, {8, 8}, {0, 8}}) == 0);
  CHECK(fan_corner(std::vector<ScreenVertex>{{0, 8}, {8, 8}, {8, 0}, {0, 0}}) == 0);
  CHECK(fan_corner(std::vector<ScreenVertex>{{0, 0}, {9, 3}, {20, 0}, {10, 12}}) == 1);
  // Corners in one place, and all on a line.
  CHECK(fan_corner(std::vector<ScreenVertex>{{3, 3}, {3, 3}, {3, 3}, {3, 3}}) == 0);
  CHECK(fan_corner(std::vector<ScreenVertex>{{0, 0}, {4, 4}, {2, 2}, {9, 9}}) == 0);
  // A corner on the first one would hide that the corners beside it turn back.
  CHECK(fan_corner(std::vector<ScreenVertex>{{0, 0}, {8, 0}, {8, 8}, {0, 0}, {8, 4}, {0, 8}}) != 0);
  // A comb, of which no corner sees all.
  CHECK_FALSE(fan_corner(
      std::vector<ScreenVertex>{{0, 0}, {30, 0}, {30, 10}, {25, 1}, {20, 10}, {15, 1}, {10, 10}, {5, 1}, {0, 10}}));
}

TEST_CASE("fan_corner: triangles of the fan cover each point of the outline once, and no other") {
  std::mt19937 random(21);
  int bent = 0;
  int without = 0;
  for (int round = 0; round < 20000; ++round) {
    const int n = 4 + static_cast<int>(random() % 4);
    std::vector<ScreenVertex> outline;
    for (int i = 0; i < n; ++i)
      outline.push_back({static_cast<std::int32_t>(random() % 7), static_cast<std::int32_t>(random() % 7)});
    const auto apex = fan_corner(outline);
    if (!apex) {
      ++without;
      continue;
    }
    bent += *apex > 0 ? 1 : 0;
    std::vector<std::vector<ScreenVertex>> triangles;
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
      triangles.push_back(
          {outline[*apex], outline[(*apex + i) % outline.size()], outline[(*apex + i + 1) % outline.size()]});
    bool same = true;
    for (int y2 = 1; y2 < 12; y2 += 2)
      for (int x2 = 1; x2 < 12; x2 += 2) {
        bool skip = on_a_side(outline, x2, y2);
        int covering = 0;
        for (const auto& t : triangles) {
          skip = skip || on_a_side(t, x2, y2);
          covering += winding(t, x2, y2) != 0 ? 1 : 0;
        }
        if (!skip) same = same && covering == std::abs(winding(outline, x2, y2)) && covering <= 1;
      }
    if (!same) FAIL("round " << round);
  }
  CHECK(bent > 100);
  CHECK(without > 100);
}
