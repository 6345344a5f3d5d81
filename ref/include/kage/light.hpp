// SPDX-License-Identifier: Apache-2.0

/// @file
/// Light that is sampled. [Matsumoto, section 6.]
#pragma once

#include <cstdint>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

/// Most samples of a light: what a pixel's counter of 8 bits holds.
inline constexpr int kMaxSamples = 255;

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

}  // namespace kage
