// SPDX-License-Identifier: Apache-2.0
#include "geometry/sampled_lights.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kage/error.hpp"
#include "kage/light.hpp"

namespace kage {
namespace {

std::vector<LightPoint> points_of(const Light& light, std::size_t number, bool casts, const Config& config,
                                  const Look& look) {
  const LightPoint& middle = light;
  if (casts && config.count_bits == 0) return {middle};
  const bool fits = !casts || !look.fit || look.samples >> config.count_bits == 0;
  auto points = light_points(light, fits ? look.samples : 1, look.seed + number);
  if (casts && points.size() >> config.count_bits > 0)
    throw Error(fmt::format("{} samples of a light do not fit COUNT_BITS = {}", points.size(), config.count_bits));
  return points;
}

// Light after light has one counter for all.
std::size_t casting_lights(const SceneFrame& frame, const Config& config) {
  if (config.dsf_bits == 0) return 0;
  if (config.linear_bits > 0) return frame.lights.size();
  return std::min(frame.lights.size(), static_cast<std::size_t>(config.lights));
}

}  // namespace

SampledLights::SampledLights(const SceneFrame& frame, const Config& config, const Look& look,
                             std::span<const glm::dvec3> near_corners)
    : casting(casting_lights(frame, config)) {
  for (std::size_t l = 0; l < frame.lights.size(); ++l) {
    first.push_back(static_cast<std::uint32_t>(points.size()));
    const auto own = kage::points_of(frame.lights[l], l, l < casting, config, look);
    const auto casters = ShadowCaster::of_points(frame, own, near_corners, look.extrusion);
    points.insert(points.end(), casters.begin(), casters.end());
    if (l < casting) light_of.insert(light_of.end(), casters.size(), static_cast<std::uint8_t>(l));
  }
  first.push_back(static_cast<std::uint32_t>(points.size()));
}

}  // namespace kage
