// SPDX-License-Identifier: Apache-2.0
// A face's shading: the colours of its corners, and its class.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/light_table.hpp"
#include "geometry/sampled_lights.hpp"
#include "geometry/shade.hpp"
#include "geometry/view.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Refers to what it is made of.
class FaceShading {
 public:
  FaceShading(const SceneFrame& frame, const Config& config, const SampledLights& lights, const Lighting& lighting,
              const LightTable& table)
      : frame_(&frame), config_(&config), lights_(&lights), lighting_(&lighting), table_(&table) {}

  /// A face with the colours of its corners.
  struct Shaded {
    bool lit;                    ///< shadows take from its colour
    std::uint32_t normal_class;  ///< into the light table, or 0
    glm::dvec3 mean;             ///< of the corners' colours
    bool same_color;             ///< at all of them
  };

  /// Gives `corners`, those of polygon `index` in its order, their colours before RESOLVE: what the points of lights
  /// before it give, and what its own shadow of those behind it will take (LightTable::before_own_shadow()). At most
  /// 255.
  Shaded shade(std::uint32_t index, std::span<ClipPoint> corners) const;

 private:
  const SceneFrame* frame_;
  const Config* config_;
  const SampledLights* lights_;
  const Lighting* lighting_;
  const LightTable* table_;
};

}  // namespace kage
