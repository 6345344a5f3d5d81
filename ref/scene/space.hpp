// SPDX-License-Identifier: Apache-2.0
//
// Lengths of vectors, and boxes along the axes, evaluated in one fixed order so that all compilers give the same bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>

namespace kage {

/// The square of the length.
inline double squared(const glm::dvec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

inline double length(const glm::dvec3& v) { return std::sqrt(squared(v)); }

/// The largest magnitude of a coordinate.
inline double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

inline bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// The points from low to high, those included; none until the first add().
struct SpaceBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  [[nodiscard]] bool contains(const glm::dvec3& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
  }
  /// Corner 0 .. 7: of x, y, z the high one where bit 0, 1, 2 is set.
  [[nodiscard]] glm::dvec3 corner(unsigned i) const {
    return {(i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z};
  }
  [[nodiscard]] double diagonal() const { return length(high - low); }
};

}  // namespace kage
