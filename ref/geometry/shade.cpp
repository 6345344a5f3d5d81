// SPDX-License-Identifier: Apache-2.0
#include "geometry/shade.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geometry/sampled_lights.hpp"
#include "kage/light.hpp"

namespace kage {
namespace {

// Ambient light is not modelled further than this: a constant, and some more from above, so that faces in shade differ.
constexpr double kAmbient = 0.20;
constexpr double kSky = 0.08;

double luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

glm::dvec3 seen(const glm::dvec3& light, bool grey) { return grey ? glm::dvec3(luminance(light)) : light; }

double ambient(const glm::dvec3& normal, const glm::dvec3& up) {
  return kAmbient + kSky * 0.5 * (1.0 + glm::dot(normal, up));
}

glm::dvec3 encoded(const glm::dvec3& light, bool grey) {
  const glm::dvec3 linear = seen(light, grey);
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

Lighting::Lighting(std::span<const Light> lights, const glm::dvec3& up, bool grey) : up_(up), grey_(grey) {
  for (const Light& l : lights) {
    first_.push_back(static_cast<std::uint32_t>(points_.size()));
    points_.push_back(l);
    points_.back().color *= 1.0 - kAmbient;
  }
  first_.push_back(static_cast<std::uint32_t>(points_.size()));
}

Lighting::Lighting(std::span<const Light> lights, const SampledLights& sampled, const glm::dvec3& up, bool grey)
    : first_(sampled.first), up_(up), grey_(grey) {
  for (std::size_t l = 0; l < lights.size(); ++l)
    for (std::uint32_t i = first_[l]; i < first_[l + 1]; ++i) {
      Light point = lights[l];
      static_cast<LightPoint&>(point) = sampled.points[i].light();
      point.color *= (1.0 - kAmbient) / sampled.points_of(l);
      points_.push_back(point);
    }
}

void Lighting::arriving(const glm::dvec3& point, const glm::dvec3& normal, std::span<const std::int8_t> sides,
                        int eye_side, std::span<glm::dvec3> out) const {
  for (std::size_t l = 0; l < out.size(); ++l) {
    out[l] = glm::dvec3(0);
    for (std::uint32_t i = first_[l]; i < first_[l + 1]; ++i)
      if (sides[i] * eye_side > 0) out[l] += received(points_[i], point, normal);
  }
}

glm::dvec3 Lighting::displayed(const glm::dvec3& normal, const glm::dvec3& base, const glm::dvec3& light) const {
  return encoded(base * (light + ambient(normal, up_)), grey_);
}

glm::dvec3 Lighting::shown_of_ambient(const glm::dvec3& normal, const glm::dvec3& base) const {
  return seen(base * ambient(normal, up_), grey_);
}

glm::dvec3 Lighting::shown_of(const glm::dvec3& base, const glm::dvec3& light) const {
  return seen(base * light, grey_);
}

glm::dvec3 Lighting::displayed_unlit(const glm::dvec3& base, bool grey) { return encoded(base, grey); }

bool Lighting::depends_on_place(std::span<const std::int8_t> sides, int eye_side) const {
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (!points_[i].directional && sides[i] * eye_side > 0) return true;
  return false;
}

}  // namespace kage
