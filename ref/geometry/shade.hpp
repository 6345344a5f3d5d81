// SPDX-License-Identifier: Apache-2.0
//
// Lighting: base colours to displayed colours.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "kage/scene.hpp"

namespace kage {

/// The sRGB transfer function by square roots alone, so that it is the same on every machine: within 0.017 of a step of
/// 1/255 of the exact one, and exact at 0 and 1. `linear` is clamped to 0 .. 1; the outcome is 0 .. 1.
double srgb_encode(double linear);

/// Where the light is, seen from a point.
class LightView {
 public:
  /// `up`: the side from which a little more ambient light comes.
  LightView(const Light& light, const glm::dvec3& up) : light_(light), up_(up) {}

  /// Vector to the light, not normalised.
  [[nodiscard]] glm::dvec3 towards(const glm::dvec3& point) const {
    return light_.directional ? -light_.direction : light_.position - point;
  }

  /// Displayed colour, 0 .. 255 a channel, of a surface point with no shadow on it. `normal` is turned to the eye
  /// already; `lit`: eye and light are on the same side of the face.
  [[nodiscard]] glm::dvec3 displayed(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& base,
                                     bool lit, bool grey) const;

 private:
  Light light_;
  glm::dvec3 up_;
};

}  // namespace kage
