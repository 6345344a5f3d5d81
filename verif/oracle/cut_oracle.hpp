// SPDX-License-Identifier: Apache-2.0
//
// The line where one plane cuts another on the picture, in rational numbers.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <glm/vec3.hpp>

#include "kage/scene.hpp"

namespace kage::verif {

/// Exact cut of a face by a node's plane at each pixel, from the corners of both faces alone.
class CutOracle {
 public:
  using Number = boost::multiprecision::cpp_rational;
  using Point = std::array<Number, 3>;
  using Face = std::array<glm::dvec3, 3>;

  static Point exact(const glm::dvec3& p) { return {Number(p.x), Number(p.y), Number(p.z)}; }

  /// Across the face's plane; all 0 if its corners lie on a line.
  static Point normal(const Face& f) {
    const Point d = minus(exact(f[1]), exact(f[0]));
    const Point e = minus(exact(f[2]), exact(f[0]));
    return {d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]};
  }

  /// `side`: that of the face on which the eye is, +1 or -1.
  CutOracle(const Camera& camera, const Face& face, const Face& node, int side, int width, int height) {
    const Point n = normal(node);
    const Point m = normal(face);
    const auto at = [&](int x, int y) -> Number {
      const Number unit = Number(camera.half_height) * 2 / height;
      const Number ex = Number(2 * x + 1 - width) / 2 * unit;
      const Number ey = Number(height - 2 * y - 1) / 2 * unit;
      Point from = exact(camera.eye);
      Point way = exact(camera.forward);
      for (std::size_t i = 0; i < 3; ++i)
        (camera.perspective ? way : from)[i] += ex * exact(camera.right)[i] + ey * exact(camera.up)[i];
      // At from + t way, t = -(m . (from - face)) / (m . way). Times m . way, which against the view is negative where
      // the eye is before the face.
      return -side *
             (dot(n, minus(from, exact(node[0]))) * dot(m, way) - dot(m, minus(from, exact(face[0]))) * dot(n, way));
    };
    c_ = at(0, 0);
    a_ = at(1, 0) - c_;
    b_ = at(0, 1) - c_;
  }

  /// The value of the node's plane where the ray of a place, in pixels from the first one's centre, meets the face's
  /// plane, times a positive factor that is the same for all places. Linear in x and y.
  [[nodiscard]] Number value(const Number& x, const Number& y) const { return a_ * x + b_ * y + c_; }

  /// Change of value() over a pixel, along x or along y, whichever is more.
  [[nodiscard]] Number slope() const { return std::max<Number>(abs(a_), abs(b_)); }

 private:
  static Point minus(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
  static Number dot(const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

  Number a_, b_, c_;
};

}  // namespace kage::verif
