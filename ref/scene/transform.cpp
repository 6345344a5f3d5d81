// SPDX-License-Identifier: Apache-2.0
#include "transform.hpp"

#include <algorithm>
#include <cmath>

#include "functions.hpp"

namespace kage::scene {

double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

glm::dvec3 unit(const glm::dvec3& v, const glm::dvec3& fallback) {
  if (!is_finite(v)) return fallback;
  const double most = largest(v);
  if (most == 0) return fallback;
  // Dividing by the largest keeps the squares in range; for most vectors it would only add a rounding.
  const bool in_range = most > 1e-100 && most < 1e100;
  const glm::dvec3 w = in_range ? v : glm::dvec3{v.x / most, v.y / most, v.z / most};
  const double l = length(w);
  return {w.x / l, w.y / l, w.z / l};
}

glm::dvec3 Affine::vector(const glm::dvec3& v) const {
  return {x.x * v.x + y.x * v.y + z.x * v.z, x.y * v.x + y.y * v.y + z.y * v.z, x.z * v.x + y.z * v.y + z.z * v.z};
}

glm::dvec3 Affine::point(const glm::dvec3& p) const {
  const glm::dvec3 v = vector(p);
  return {v.x + origin.x, v.y + origin.y, v.z + origin.z};
}

glm::dvec3 Affine::normal(const glm::dvec3& n) const {
  const Affine cofactors{cross(y, z), cross(z, x), cross(x, y), {0, 0, 0}};
  const glm::dvec3 m = cofactors.vector(n);
  return determinant() < 0 ? glm::dvec3{-m.x, -m.y, -m.z} : m;
}

double Affine::determinant() const { return dot(cross(x, y), z); }

Affine operator*(const Affine& outer, const Affine& inner) {
  return {outer.vector(inner.x), outer.vector(inner.y), outer.vector(inner.z), outer.point(inner.origin)};
}

Quaternion normalized(const Quaternion& q) {
  const double l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(l > 0) || !std::isfinite(l)) return {};
  return {q.x / l, q.y / l, q.z / l, q.w / l};
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double u) {
  const double sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? -1 : 1;
  const Quaternion c{sign * b.x, sign * b.y, sign * b.z, sign * b.w};
  // The angle between them from the chords of difference and sum: exact for small angles, where acos of the dot product
  // would lose half its digits.
  const Quaternion d{c.x - a.x, c.y - a.y, c.z - a.z, c.w - a.w};
  const Quaternion s{c.x + a.x, c.y + a.y, c.z + a.z, c.w + a.w};
  const double chord = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z + d.w * d.w);
  const double sum = std::sqrt(s.x * s.x + s.y * s.y + s.z * s.z + s.w * s.w);
  double from = 1 - u;
  double to = u;
  if (chord > 1e-8) {
    const double angle = 2 * portable::atan2(chord, sum);
    const double sine = portable::sin(angle);
    from = portable::sin(from * angle) / sine;
    to = portable::sin(to * angle) / sine;
  }
  return normalized({from * a.x + to * c.x, from * a.y + to * c.y, from * a.z + to * c.z, from * a.w + to * c.w});
}

Affine compose(const glm::dvec3& translation, const Quaternion& rotation, const glm::dvec3& scale) {
  const Quaternion q = normalized(rotation);
  const glm::dvec3 x{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y + q.z * q.w), 2 * (q.x * q.z - q.y * q.w)};
  const glm::dvec3 y{2 * (q.x * q.y - q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z + q.x * q.w)};
  const glm::dvec3 z{2 * (q.x * q.z + q.y * q.w), 2 * (q.y * q.z - q.x * q.w), 1 - 2 * (q.x * q.x + q.y * q.y)};
  return {{x.x * scale.x, x.y * scale.x, x.z * scale.x},
          {y.x * scale.y, y.y * scale.y, y.z * scale.y},
          {z.x * scale.z, z.y * scale.z, z.z * scale.z},
          translation};
}

}  // namespace kage::scene
