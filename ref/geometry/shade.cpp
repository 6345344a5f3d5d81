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

double luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

glm::dvec3 encoded(const glm::dvec3& light, bool grey) {
  const glm::dvec3 linear = grey ? glm::dvec3(luminance(light)) : light;
  return 255.0 * glm::dvec3(srgb_encode(linear.x), srgb_encode(linear.y), srgb_encode(linear.z));
}

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

double Lighting::ambient(const glm::dvec3& normal) const {
  return kAmbient + kSky * 0.5 * (1.0 + glm::dot(normal, up_));
}

glm::dvec3 Lighting::displayed(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& base,
                               const std::bitset<kMaxLights>& lit, bool grey) const {
  glm::dvec3 light = glm::dvec3(ambient(normal));
  for (std::size_t l = 0; l < lights_.size(); ++l)
    if (lit[l]) light += received(lights_[l], point, normal) * (1.0 - kAmbient);
  return encoded(base * light, grey);
}

glm::dvec3 Lighting::displayed_unlit(const glm::dvec3& base, bool grey) { return encoded(base, grey); }

std::vector<glm::dvec3> Lighting::shares(const glm::dvec3& point, const glm::dvec3& normal,
                                         const std::bitset<kMaxLights>& lit, bool grey) const {
  std::vector<glm::dvec3> parts(lights_.size(), glm::dvec3(0));
  glm::dvec3 sum{0, 0, 0};
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    if (!lit[l]) continue;
    parts[l] = received(lights_[l], point, normal) * (1.0 - kAmbient);
    if (grey) parts[l] = glm::dvec3(luminance(parts[l]));
    sum += parts[l];
  }
  const double dark = ambient(normal);
  for (int c = 0; c < 3; ++c) {
    const double loss = 1 - srgb_encode(dark) / srgb_encode(dark + sum[c]);
    for (glm::dvec3& part : parts) part[c] = sum[c] > 0 ? loss * (part[c] / sum[c]) : 0;
  }
  return parts;
}

}  // namespace kage
