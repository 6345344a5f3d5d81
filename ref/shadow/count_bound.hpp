// SPDX-License-Identifier: Apache-2.0
//
// The largest winding number of a set of edges over a square of the plane, bounded from above, in integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kage {

/// Coordinates are even and within +-kChartReach.
struct ChartPoint {
  std::int64_t x = 0;
  std::int64_t y = 0;

  bool operator==(const ChartPoint&) const = default;
  bool operator<(const ChartPoint& o) const { return x != o.x ? x < o.x : y < o.y; }
};

/// Left of the way from a to b w more than right of it.
struct ChartEdge {
  ChartPoint a;
  ChartPoint b;
  std::int32_t w = 1;
};

inline constexpr std::int64_t kChartReach = std::int64_t{1} << 41;
/// The square looked at reaches from -kChartHalf - 1 to kChartHalf - 1 in x and in y.
inline constexpr std::int64_t kChartHalf = std::int64_t{1} << 40;

/// low <= the largest count <= high.
struct CountRange {
  int low = 0;
  int high = 0;
};

/// The largest count over the square, but for the edges themselves. `base`: the count at its lower left corner. Inside
/// the square edges end only where others go on, so that the count is the same whichever way it is followed. Stops once
/// high <= target or low > target (target < 0: not before they are equal), or where cells get no smaller, or after a
/// stated amount of work: high is an upper bound in any case. Changes the order of `edges` and puts equal ones
/// together.
CountRange bound_count(std::vector<ChartEdge>& edges, int base, int target);

}  // namespace kage
