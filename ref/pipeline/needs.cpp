// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "kage/pipeline.hpp"

namespace kage {
namespace {

bool is_grey(const glm::dvec3& c) { return c.x == c.y && c.y == c.z; }

}  // namespace

Needs needs_of(const Scene& scene, const SceneFrame& frame, int width, int height, int samples) {
  Needs needs;
  needs.width = width;
  needs.height = height;
  std::size_t casters = 0;
  for (const Component& c : frame.components) {
    needs.translucency = needs.translucency || c.translucent;
    if (c.translucent) continue;
    ++casters;
    needs.several_volumes = needs.several_volumes || casters > 1 || !c.convex;
  }
  needs.shadows = casters > 0;
  needs.smooth = scene.needs_smooth();
  needs.lights = static_cast<int>(frame.lights.size());
  const auto any_light = [&](auto what) { return std::any_of(frame.lights.begin(), frame.lights.end(), what); };
  if (any_light([](const Light& l) { return l.shape != LightShape::point; })) needs.samples = samples;
  needs.color =
      any_light([](const Light& l) { return !is_grey(l.color); }) ||
      std::any_of(frame.shading.begin(), frame.shading.end(), [](const ShadingVertex& v) { return !is_grey(v.color); });
  Config counted;
  counted.count_bits = kGreatest.count_bits;
  Look look;
  look.samples = samples;
  const LightDemand light = light_demand(frame, counted, look);
  needs.share_error = light.share_error;
  needs.color_spread = light.color_spread;
  return needs;
}

}  // namespace kage
