// SPDX-License-Identifier: Apache-2.0
//
// Which way corners of caps go round as the light sees them.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "shadow/world_volume.hpp"

namespace kage {

/// The corners of caps, with a place of each that most questions can be answered by.
///
/// Let u be 2^-53 and m the largest coordinate of a place. A point light's places are corner - light, each coordinate
/// off by a factor within 1 +- u. Turns are their determinant: six products of three, each within m^3 and off by less
/// than 10 u m^3 with its roundings and sums. Together that is less than 2^6 u m^3.
///
/// A directional light is turned so that z is the largest coordinate of its direction l. Its places are
/// (x - s z, y - t z), with s and t the quotients lx / lz and ly / lz, rounded. Let n be the true corners' normal and m
/// now the largest coordinate of a corner. Twice the area of the triangle of the exact such places is nx s + ny t + nz.
/// It is n . l / lz up to u (|nx| + |ny|), which is at most 16 u m^2. A place is off by less than 3.1 u m. A
/// difference of two is within 4 m and off by less than 10.4 u m, a product of differences by less than 100 u m^2, and
/// the area by less than 233 u m^2. Together that is less than 2^8 u m^2.
///
/// light_turn() decides turns that are not beyond twice these bounds. It also decides where m is so large or small that
/// a product may leave the range of doubles.
class LightCorners {
 public:
  /// Refers to `frame`.
  LightCorners(const SceneFrame& frame, const LightPoint& light, std::span<const CapFace> caps);

  /// Corners of a cap.
  [[nodiscard]] std::uint32_t size(std::uint32_t cap) const { return first_[cap + 1] - first_[cap]; }

  /// Corner i of a cap, modulo their number, in the order in which they go round seen from the light.
  [[nodiscard]] std::uint32_t corner(std::uint32_t cap, std::uint32_t i) const {
    const std::uint32_t n = size(cap);
    return first_[cap] + (i < n ? i : i % n);
  }

  /// 1 if three corners go round counter-clockwise as the light sees them, -1 if clockwise, 0 if they are in one plane
  /// with its rays: exactly.
  [[nodiscard]] int turn(std::uint32_t p, std::uint32_t q, std::uint32_t r) const {
    const double s = area(p, q, r);
    if (std::abs(s) > limit_) return s > 0 ? 1 : -1;
    return exact_turn(p, q, r);
  }

  /// Whether a corner is surely not to the left of the line from p to q. Without a branch: mostly it cannot be
  /// foreseen.
  [[nodiscard]] bool surely_not_left(std::uint32_t p, std::uint32_t q, std::uint32_t r) const {
    const int on_line = static_cast<int>(vertex_[r] == vertex_[p]) | static_cast<int>(vertex_[r] == vertex_[q]);
    return (on_line | static_cast<int>(area(p, q, r) < -limit_)) != 0;
  }

 private:
  // Something with the sign of turn() if it is beyond limit_.
  [[nodiscard]] double area(std::uint32_t p, std::uint32_t q, std::uint32_t r) const {
    const glm::dvec3& a = at_[p];
    const glm::dvec3& b = at_[q];
    const glm::dvec3& c = at_[r];
    return sign_ *
           (light_.directional ? (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) : glm::dot(a, glm::cross(b, c)));
  }
  [[nodiscard]] int exact_turn(std::uint32_t p, std::uint32_t q, std::uint32_t r) const;

  const SceneFrame* frame_;
  LightPoint light_;
  std::vector<std::uint32_t> first_;   // corners by cap
  std::vector<std::uint32_t> vertex_;  // of the frame, by corner
  std::vector<glm::dvec3> at_;         // places, by corner
  double limit_ = 0;
  double sign_ = -1;
};

/// Sign of the area of p, q, r (vertices of the frame) as the light sees them: 1 if they go round counter-clockwise,
/// exactly.
int light_turn(const SceneFrame& frame, const LightPoint& light, std::uint32_t p, std::uint32_t q, std::uint32_t r);

}  // namespace kage
