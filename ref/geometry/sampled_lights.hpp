// SPDX-License-Identifier: Apache-2.0
// The lights of a frame as points that shine and cast shadows.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kage/geometry.hpp"
#include "shadow/shadow_caster.hpp"

namespace kage {

/// All lights shine from their samples, the first ones cast shadows, too: as many as the configuration tells apart, all
/// with linear light, none without shadows. A light that casts and has no counter is its middle.
struct SampledLights {
  /// Throws Error where a light has more samples than COUNT_BITS holds.
  /// `near_corners`: View::near_corners(), past which shadows reach.
  SampledLights(const SceneFrame& frame, const Config& config, const Look& look,
                std::span<const glm::dvec3> near_corners);

  /// How many points light `l` is.
  [[nodiscard]] int points_of(std::size_t l) const { return static_cast<int>(first[l + 1] - first[l]); }

  /// The points that cast, light by light.
  [[nodiscard]] std::span<const ShadowCaster> samples() const { return std::span(points).first(light_of.size()); }

  std::vector<ShadowCaster> points;    ///< of all lights, light by light
  std::vector<std::uint32_t> first;    ///< of each light its first of them, and their number
  std::size_t casting = 0;             ///< how many lights cast
  std::vector<std::uint8_t> light_of;  ///< of each sample, its light
};

}  // namespace kage
