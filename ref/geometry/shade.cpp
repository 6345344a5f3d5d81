// SPDX-License-Identifier: Apache-2.0
#include "geometry/shade.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "kage/light.hpp"

namespace kage {
namespace {

// Ambient light is not modelled further than this: a constant, and some more from above, so that faces in shade differ.
constexpr double kAmbient = 0.20;
constexpr double kSky = 0.08;

}  // namespace

double srgb_encode(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  if (x <= 0.0031308) return 12.92 * x;
  if (x >= 1) return 1;
  // Least squares fit of 1.055 x^(1/2.4) - 0.055 over square roots, constant chosen so that 1 stays 1.
  const double s1 = std::sqrt(x);
  const double s2 = std::sqrt(s1);
  const double s3 = std::sqrt(s2);
  return 0.653986 * s1 + 0.688709 * s2 - 0.318471 * s3 - 0.020188 * x - 0.004036;
}

glm::dvec3 Lighting::displayed(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& base,
                               const std::bitset<kMaxLights>& lit, bool grey) const {
  glm::dvec3 light = glm::dvec3(kAmbient + kSky * 0.5 * (1.0 + glm::dot(normal, up_)));
  for (std::size_t l = 0; l < lights_.size(); ++l)
    if (lit[l]) light += received(lights_[l], point, normal) * (1.0 - kAmbient);
  glm::dvec3 linear = base * light;
  if (grey) linear = glm::dvec3(0.2126 * linear.x + 0.7152 * linear.y + 0.0722 * linear.z);
  return 255.0 * glm::dvec3(srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z));
}

std::vector<glm::dvec3> light_shares(std::span<const Light> lights, const glm::dvec3& point, const glm::dvec3& normal,
                                     bool grey) {
  std::vector<glm::dvec3> parts;
  glm::dvec3 sum{0, 0, 0};
  for (const Light& l : lights) {
    glm::dvec3 part = received(l, point, normal);
    if (grey) part = glm::dvec3(0.2126 * part.x + 0.7152 * part.y + 0.0722 * part.z);
    parts.push_back(part);
    sum += part;
  }
  for (glm::dvec3& part : parts)
    for (int c = 0; c < 3; ++c) part[c] = sum[c] > 0 ? part[c] / sum[c] : 0;
  return parts;
}

}  // namespace kage
