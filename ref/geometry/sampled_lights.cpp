// SPDX-License-Identifier: Apache-2.0
#include "geometry/sampled_lights.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kage/error.hpp"
#include "kage/light.hpp"

namespace kage {
namespace {

// The middle, then the samples of a light that casts, unless they are the middle.
std::vector<LightPoint> points_of(const Light& light, std::size_t number, bool casts, const Config& config,
                                  const Look& look) {
  const LightPoint& middle = light;
  std::vector<LightPoint> points{middle};
  if (!casts || config.count_bits == 0) return points;
  const bool fits = !look.fit || look.samples >> config.count_bits == 0;
  const auto samples = light_points(light, fits ? look.samples : 1, look.seed + number);
  if (samples.size() > 1) points.insert(points.end(), samples.begin(), samples.end());
  if (samples.size() >> config.count_bits > 0)
    throw Error(fmt::format("{} samples of a light do not fit COUNT_BITS = {}", samples.size(), config.count_bits));
  return points;
}

}  // namespace

SampledLights::SampledLights(const SceneFrame& frame, const Config& config, const Look& look, const View& view) {
  const std::size_t casting =
      config.dsf_bits > 0 ? std::min(frame.lights.size(), static_cast<std::size_t>(config.lights)) : 0;
  for (std::size_t l = 0; l < frame.lights.size(); ++l) {
    const auto points = points_of(frame.lights[l], l, l < casting, config, look);
    const auto casters = ShadowCaster::of_points(frame, points, view.near_corners(), look.extrusion);
    middles.push_back(casters[0]);
    if (l >= casting) continue;
    const auto first = casters.begin() + (points.size() > 1 ? 1 : 0);
    samples.insert(samples.end(), first, casters.end());
    const auto count = static_cast<std::size_t>(casters.end() - first);
    samples_of.push_back(static_cast<int>(count));
    light_of.insert(light_of.end(), count, static_cast<std::uint8_t>(l));
  }
}

}  // namespace kage
