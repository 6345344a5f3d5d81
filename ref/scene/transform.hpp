// SPDX-License-Identifier: Apache-2.0
//
// Affine maps and rotations in double, evaluated in one fixed order so that all compilers give the same bits.
#pragma once

#include <glm/vec3.hpp>

#include "space.hpp"

namespace kage::scene {

/// p -> x * p.x + y * p.y + z * p.z + origin.
struct Affine {
  glm::dvec3 x{1, 0, 0};
  glm::dvec3 y{0, 1, 0};
  glm::dvec3 z{0, 0, 1};
  glm::dvec3 origin{0, 0, 0};

  [[nodiscard]] glm::dvec3 point(const glm::dvec3& p) const;
  [[nodiscard]] glm::dvec3 vector(const glm::dvec3& v) const;
  /// Map of normals, up to length: the matrix of cofactors, negated where the map mirrors.
  [[nodiscard]] glm::dvec3 normal(const glm::dvec3& n) const;
  [[nodiscard]] double determinant() const;
};

/// First `inner`, then `outer`.
Affine operator*(const Affine& outer, const Affine& inner);

struct Quaternion {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;
};

/// The quaternion scaled to length 1; the identity for one of length 0.
Quaternion normalized(const Quaternion& q);

/// The shorter way from a to b, at constant speed; u = 0 gives a and u = 1 gives b (or -b). Both of length 1.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double u);

/// Scale first, then rotate (the quaternion is normalised), then translate.
Affine compose(const glm::dvec3& translation, const Quaternion& rotation, const glm::dvec3& scale);

double dot(const glm::dvec3& a, const glm::dvec3& b);
glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b);

/// v / |v|, also where |v|^2 under- or overflows; `fallback` if v is 0 or not finite.
glm::dvec3 unit(const glm::dvec3& v, const glm::dvec3& fallback);

}  // namespace kage::scene
