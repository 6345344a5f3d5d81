// SPDX-License-Identifier: Apache-2.0
//
// Which lines of pixels a fragment may have pixels on.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "kage/geometry.hpp"

namespace kage {

/// Lines of pixels of the part of an outline that lies on the wanted sides of cut lines, and up to a subpixel beyond
/// them. They are never fewer than the fragment's: each of its spans lies within the outline, at pixel centres on the
/// wanted sides.
class LineSearch {
 public:
  void start(std::span<const ScreenVertex> outline) {
    points_.clear();
    for (const ScreenVertex& v : outline) points_.push_back({v.x / 256.0 - 0.5, v.y / 256.0 - 0.5});
  }

  void cut(const CutLine& line, bool front) {
    const double sign = front ? 1 : -1;
    const double a = sign * static_cast<double>(line.a);
    const double b = sign * static_cast<double>(line.b);
    // A subpixel, and what rounding of these sums in doubles can do, which is far less.
    const double slack = (std::abs(a) + std::abs(b)) / 256 + 1;
    const double c = sign * static_cast<double>(line.c) + slack;
    kept_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point& p = points_[i];
      const Point& q = points_[(i + 1) % points_.size()];
      const double at_p = a * p.x + b * p.y + c;
      const double at_q = a * q.x + b * q.y + c;
      if (at_p >= 0) kept_.push_back(p);
      if ((at_p >= 0) == (at_q >= 0)) continue;
      const double t = at_p / (at_p - at_q);
      kept_.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
    }
    points_.swap(kept_);
  }

  /// Add the lines to [first, end).
  void join(std::int32_t& first, std::int32_t& end) const {
    for (const Point& p : points_) {
      first = std::min(first, static_cast<std::int32_t>(std::floor(p.y)) - 1);
      end = std::max(end, static_cast<std::int32_t>(std::floor(p.y)) + 3);
    }
  }

 private:
  struct Point {
    double x;
    double y;
  };
  std::vector<Point> points_;
  std::vector<Point> kept_;
};

}  // namespace kage
