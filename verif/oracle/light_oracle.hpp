// SPDX-License-Identifier: Apache-2.0
//
// How many polygons of a plane have a point in common, in rational numbers.
#pragma once

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <functional>
#include <vector>

namespace kage::verif {

using Rational = boost::multiprecision::cpp_rational;

struct ExactPoint {
  Rational x, y;
};
using ExactPolygon = std::vector<ExactPoint>;

inline Rational turn(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// The part of a convex polygon left of the way from a to b; empty if it has no area.
inline ExactPolygon left_of(const ExactPolygon& polygon, const ExactPoint& a, const ExactPoint& b) {
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
inline int exact_most(const std::vector<ExactPolygon>& triangles) {
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

}  // namespace kage::verif
