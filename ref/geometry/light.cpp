// SPDX-License-Identifier: Apache-2.0
#include "kage/light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "number/mixed.hpp"
#include "scene/functions.hpp"
#include "scene/space.hpp"

namespace kage {
namespace {

/// 0 .. 1 from the upper bits.
double share(std::uint64_t x) { return static_cast<double>(x >> 11U) * 0x1p-53; }

struct Direction {
  explicit Direction(std::uint64_t turn) {
    const double angle = 2 * portable::kPi * share(turn);
    cosine = portable::cos(angle);
    sine = portable::sin(angle);
  }
  double cosine;
  double sine;
};

/// From the light's middle to the sample at `along`, 0 .. 1, and `turn` of a full turn's 2^64.
glm::dvec3 offset(const Light& light, double along, std::uint64_t turn) {
  switch (light.shape) {
    case LightShape::point:
      break;
    case LightShape::rectangle:
      return light.axis_u * (2 * along - 1) + light.axis_v * (2 * share(turn) - 1);
    case LightShape::disc: {
      const Direction d(turn);
      const double radius = std::sqrt(along);
      return light.axis_u * (radius * d.cosine) + light.axis_v * (radius * d.sine);
    }
    case LightShape::sphere: {
      const Direction d(turn);
      const double z = 1 - 2 * along;
      const double radius = std::sqrt(1 - z * z);
      return glm::dvec3(radius * d.cosine, radius * d.sine, z) * light.axis_u.x;
    }
  }
  return {0, 0, 0};
}

}  // namespace

std::vector<LightPoint> light_points(const Light& light, int samples, std::uint64_t seed) {
  const LightPoint& middle = light;
  if (light.shape == LightShape::point || light.directional || samples < 2) return {middle};
  std::vector<LightPoint> points;
  const std::uint64_t start = mixed(seed);
  for (int i = 0; i < samples; ++i) {
    const double along = (i + 0.5) / samples;
    const std::uint64_t turn = start + kGoldenRatio * static_cast<std::uint64_t>(i);
    points.push_back(middle);
    points.back().position += offset(light, along, turn);
  }
  return points;
}

double attenuation(const Light& light, const glm::dvec3& point) {
  if (light.directional) return 1;
  const glm::dvec3 from = point - light.position;
  const double distance2 = squared(from);
  if (!(distance2 > 0)) return 0;
  double a = 1;
  if (light.falls_off) {
    a = std::min(1 / distance2, 1e100);  // so that no product is infinite
    if (light.range > 0) {
      const double q = distance2 / (light.range * light.range);
      a *= std::clamp(1 - q * q, 0.0, 1.0);
    }
  }
  if (light.spot) {
    const double cosine = glm::dot(from, light.direction) / std::sqrt(distance2);
    const double t =
        std::clamp((cosine - light.outer_cosine) / std::max(0.001, light.inner_cosine - light.outer_cosine), 0.0, 1.0);
    a *= t * t;
  }
  return a;
}

glm::dvec3 received(const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
  const glm::dvec3 to = light.directional ? -light.direction : light.position - point;
  const double distance = length(to);
  const double cosine = distance > 0 ? glm::dot(to, normal) / distance : 0;
  return light.color * (attenuation(light, point) * std::max(cosine, 0.0));
}

NormalClasses::NormalClasses(int count) {
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count;
    const double radius = std::sqrt(1 - z * z);
    const Direction d(kGoldenRatio * static_cast<std::uint64_t>(i));
    normals_.emplace_back(radius * d.cosine, radius * d.sine, z);
  }
}

int NormalClasses::nearest(const glm::dvec3& unit) const {
  // From the one next in z outwards, until z alone is further off than the best.
  const auto n = static_cast<std::ptrdiff_t>(normals_.size());
  const auto start =
      std::clamp(static_cast<std::ptrdiff_t>((1 - unit.z) / 2 * static_cast<double>(n)), std::ptrdiff_t{0}, n - 1);
  double best = INFINITY;
  std::ptrdiff_t number = start;
  for (const std::ptrdiff_t step : {-1, 1})
    for (std::ptrdiff_t i = step < 0 ? start : start + 1; i >= 0 && i < n; i += step) {
      const glm::dvec3& normal = normals_[static_cast<std::size_t>(i)];
      const double off = normal.z - unit.z;
      if (off * off > best) break;
      const double distance = squared(normal - unit);
      if (distance < best || (distance == best && i < number)) {
        best = distance;
        number = i;
      }
    }
  return static_cast<int>(number) + 1;
}

}  // namespace kage
