// SPDX-License-Identifier: Apache-2.0
//
// Light that is sampled, and normals that are put in classes. [Matsumoto, section 6.]
#pragma once

#include <cstdint>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

/// Most samples of a light: what a pixel's counter of 8 bits holds.
inline constexpr int kMaxSamples = 255;

/// Most normals that a light table tells apart.
inline constexpr int kMaxClasses = 2047;

/// The points that stand for a light, 1 <= samples <= kMaxSamples: a point or directional light's own one; of another
/// its middle if `samples` is 1, else that many, spread evenly over its shape: the disc by a golden spiral, the
/// rectangle by the lattice of the golden ratio, the ball's surface by a golden spiral from pole to pole. `seed` turns
/// or shifts the pattern. The same on every machine.
std::vector<LightPoint> light_points(const Light& light, int samples, std::uint64_t seed);

/// Share of its intensity that reaches a point, without regard to its angle there: fall-off, range and cone, >= 0.
double attenuation(const Light& light, const glm::dvec3& point);

/// What a surface at `point`, facing along the unit vector `normal`, gets of the light: its colour, attenuated, times
/// the cosine; 0 from behind.
glm::dvec3 received(const Light& light, const glm::dvec3& point, const glm::dvec3& normal);

/// Unit normals spread evenly over the sphere, on a golden spiral from pole to pole, numbered from 1.
class NormalClasses {
 public:
  /// 1 <= count <= kMaxClasses.
  explicit NormalClasses(int count);

  [[nodiscard]] int count() const { return static_cast<int>(normals_.size()); }
  /// The normal of class 1 .. count().
  [[nodiscard]] const glm::dvec3& normal(int number) const { return normals_[static_cast<std::size_t>(number - 1)]; }
  /// The class whose normal is nearest; of several the first.
  [[nodiscard]] int nearest(const glm::dvec3& unit) const;

 private:
  std::vector<glm::dvec3> normals_;  // by falling z
};

}  // namespace kage
