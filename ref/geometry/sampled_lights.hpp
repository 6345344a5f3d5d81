// SPDX-License-Identifier: Apache-2.0
// The lights of a frame as points that cast shadows.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/view.hpp"
#include "kage/geometry.hpp"
#include "shadow/shadow_caster.hpp"

namespace kage {

/// All lights shine, the first ones cast shadows: as many as the configuration tells apart, none without shadows.
struct SampledLights {
  /// Throws Error where a light has more samples than COUNT_BITS holds.
  SampledLights(const SceneFrame& frame, const Config& config, const Look& look, const View& view);

  /// How many lights cast.
  [[nodiscard]] std::size_t casting() const { return samples_of.size(); }

  std::vector<ShadowCaster> middles;   ///< of all lights
  std::vector<ShadowCaster> samples;   ///< of those that cast, light by light
  std::vector<int> samples_of;         ///< of each light that casts, how many
  std::vector<std::uint8_t> light_of;  ///< of each sample, its light
};

}  // namespace kage
