// SPDX-License-Identifier: Apache-2.0
//
// Lighting: base colours to displayed colours.
#pragma once

#include <bitset>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

/// The sRGB transfer function by square roots alone, so that it is the same on every machine: within 0.017 of a step of
/// 1/255 of the exact one, and exact at 0 and 1. `linear` is clamped to 0 .. 1; the outcome is 0 .. 1.
double srgb_encode(double linear);

/// The lights of a frame, as they shine on its surfaces where there is no shadow.
class Lighting {
 public:
  /// `up`: the side from which a little more ambient light comes. Refers to `lights`.
  Lighting(std::span<const Light> lights, const glm::dvec3& up) : lights_(lights), up_(up) {}

  /// Displayed colour, 0 .. 255 a channel, of a surface point with no shadow on it. `normal` is turned to the eye
  /// already; `lit`: of each light whether eye and light are on the same side of the face.
  [[nodiscard]] glm::dvec3 displayed(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& base,
                                     const std::bitset<kMaxLights>& lit, bool grey) const;

  /// Displayed colour of a surface that shows its base colour whatever light falls on it.
  [[nodiscard]] static glm::dvec3 displayed_unlit(const glm::dvec3& base, bool grey);

  /// Whether displayed() with these lights depends on the point.
  [[nodiscard]] bool depends_on_place(const std::bitset<kMaxLights>& lit) const {
    for (std::size_t l = 0; l < lights_.size(); ++l)
      if (lit[l] && !lights_[l].directional) return true;
    return false;
  }

  /// For each light and channel, the share of its displayed colour that a white surface there loses in full shadow of
  /// the light. It is a part of the loss in full shadow of all lights: the light's part of all direct light.
  [[nodiscard]] std::vector<glm::dvec3> shares(const glm::dvec3& point, const glm::dvec3& normal,
                                               const std::bitset<kMaxLights>& lit, bool grey) const;

 private:
  [[nodiscard]] double ambient(const glm::dvec3& normal) const;

  std::span<const Light> lights_;
  glm::dvec3 up_;
};

}  // namespace kage
