// SPDX-License-Identifier: Apache-2.0

/// @file
/// Light that is sampled, and normals that are put in classes. [Matsumoto, section 6.]
#pragma once

#include <cstdint>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

/// Most samples of a light: what a pixel's counter of 8 bits holds.
inline constexpr int kMaxSamples = 255;

/// Most normals that a light table tells apart.
inline constexpr int kMaxClasses = 2047;

/// The points that stand for a light. A straight edge anywhere keeps out nearly the same share of the points as of the
/// light. On a disc they lie on a golden spiral. On a rectangle they lie on a lattice after the golden ratio, one in
/// each of `samples` columns and rows of equal width. Within a ball they are spread so that from every direction they
/// are even over the disc that is seen. docs/lights.md, "Samples", says how near, and why. The same on every machine.
/// [Matsumoto, section 6.]
/// @param light any light
/// @param samples 1 .. kMaxSamples
/// @param seed turns the pattern of a disc or a ball, shifts that of a rectangle
/// @return a point or directional light's own one; of another its middle if `samples` is 1, else that many
std::vector<LightPoint> light_points(const Light& light, int samples, std::uint64_t seed);

/// How much of a light arrives at a place: fall-off, range and cone.
/// @param light any light
/// @param point in world space
/// @return share of its intensity that reaches the point, without regard to its angle there, >= 0
double attenuation(const Light& light, const glm::dvec3& point);

/// Light that a surface gets from one light.
/// @param light any light
/// @param point of the surface, in world space
/// @param normal of the surface there, of length 1
/// @return linear: the light's colour, attenuated, times the cosine; 0 from behind
glm::dvec3 received(const Light& light, const glm::dvec3& point, const glm::dvec3& normal);

/// Unit normals spread evenly over the sphere, on a golden spiral from pole to pole, numbered from 1.
class NormalClasses {
 public:
  /// The classes of a light table.
  /// @param count how many, 1 .. kMaxClasses
  explicit NormalClasses(int count);

  /// @return how many classes there are
  [[nodiscard]] int count() const { return static_cast<int>(normals_.size()); }

  /// The normal of a class. Not checked.
  /// @param number of the class, 1 .. count()
  /// @return of length 1
  [[nodiscard]] const glm::dvec3& normal(int number) const { return normals_[static_cast<std::size_t>(number - 1)]; }

  /// Puts a normal in a class.
  /// @param unit of length 1
  /// @return the number of the class whose normal is nearest; of several the first
  [[nodiscard]] int nearest(const glm::dvec3& unit) const;

 private:
  std::vector<glm::dvec3> normals_;  // by falling z
};

}  // namespace kage
