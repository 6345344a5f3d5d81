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

// How far consecutive samples of a ball are apart, of a turn and of half a turn, and where the half turns start. Found
// by trying; `tools/bench light_points` holds them against others at random (docs/lights.md, "Samples").
constexpr auto kBallTurn = static_cast<std::uint64_t>(0.29 * 0x1p64);
constexpr auto kBallHalfTurn = static_cast<std::uint64_t>(0.187 * 0x1p64);
constexpr auto kBallStart = static_cast<std::uint64_t>(0.99 * 0x1p64);

/// Rank of each number among all, from 0. No two may be equal.
std::vector<int> places(const std::vector<std::uint64_t>& numbers) {
  std::vector<std::uint64_t> sorted = numbers;
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> places;
  for (const std::uint64_t n : numbers)
    places.push_back(static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), n) - sorted.begin()));
  return places;
}

// Offsets from the light's middle to each of its samples, one function for each shape. `middle(i)` is the middle of the
// i-th of `samples` equal parts of 0 .. 1.

template <class Middle>
std::vector<glm::dvec3> on_disc(const Light& light, int samples, std::uint64_t start, const Middle& middle) {
  std::vector<glm::dvec3> offsets;
  for (int i = 0; i < samples; ++i) {
    const Direction d(start + kGoldenRatio * static_cast<std::uint64_t>(i));
    const double radius = std::sqrt(middle(i));
    offsets.push_back(light.axis_u * (radius * d.cosine) + light.axis_v * (radius * d.sine));
  }
  return offsets;
}

template <class Middle>
std::vector<glm::dvec3> on_rectangle(const Light& light, int samples, std::uint64_t start, const Middle& middle) {
  std::vector<std::uint64_t> across;
  for (int i = 0; i < samples; ++i) across.push_back(start + kGoldenRatio * static_cast<std::uint64_t>(i));
  const std::vector<int> place = places(across);
  std::vector<glm::dvec3> offsets;
  for (int i = 0; i < samples; ++i)
    offsets.push_back(light.axis_u * (2 * middle(i) - 1) +
                      light.axis_v * (2 * middle(place[static_cast<std::size_t>(i)]) - 1));
  return offsets;
}

// Seen from any direction, a ball is a disc. The density within the unit ball whose projection is even over the disc,
// in every direction, is 1 / (pi^2 sqrt(1 - r^2)) (docs/lights.md has why). The unit sphere of four dimensions,
// projected to three, has just that density. Its points are
//   (sqrt(u) (cos a, sin a), sqrt(1 - u) (cos b, sin b)), u even over 0 .. 1, a and b each over a turn.
// The projection leaves out the fourth coordinate, with sin b, so half a turn of b is all of it.
template <class Middle>
std::vector<glm::dvec3> in_ball(const Light& light, int samples, std::uint64_t start, const Middle& middle) {
  std::vector<glm::dvec3> offsets;
  for (int i = 0; i < samples; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    const Direction a(start + kBallTurn * n);
    const Direction b((kBallStart + kBallHalfTurn * n) >> 1U);
    const double radius = std::sqrt(middle(i));
    const double height = std::sqrt(1 - middle(i));
    offsets.push_back(glm::dvec3(radius * a.cosine, radius * a.sine, height * b.cosine) * light.axis_u.x);
  }
  return offsets;
}

}  // namespace

std::vector<LightPoint> light_points(const Light& light, int samples, std::uint64_t seed) {
  const LightPoint& middle = light;
  if (light.shape == LightShape::point || light.directional || samples < 2) return {middle};
  const std::uint64_t start = mixed(seed);
  const auto part = [samples](int i) { return (i + 0.5) / samples; };
  const auto offsets = light.shape == LightShape::disc        ? on_disc(light, samples, start, part)
                       : light.shape == LightShape::rectangle ? on_rectangle(light, samples, start, part)
                                                              : in_ball(light, samples, start, part);
  std::vector<LightPoint> points;
  for (const glm::dvec3& offset : offsets) {
    points.push_back(middle);
    points.back().position += offset;
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

}  // namespace kage
