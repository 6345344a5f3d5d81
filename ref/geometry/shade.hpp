// SPDX-License-Identifier: Apache-2.0
//
// Lighting: base colours to displayed colours.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

struct SampledLights;

/// The sRGB transfer function by square roots alone, so that it is the same on every machine: within 0.017 of a step of
/// 1/255 of the exact one, and exact at 0 and 1. `linear` is clamped to 0 .. 1; the outcome is 0 .. 1.
double srgb_encode(double linear);

/// The lights of a frame, as their points shine on its surfaces where there is no shadow.
class Lighting {
 public:
  /// Each light shines from its middle. `up`: the side from which a little more ambient light comes. `grey`: with the
  /// luminance of colours alone.
  Lighting(std::span<const Light> lights, const glm::dvec3& up, bool grey);
  /// Each light shines from its points, each of which has its part of the light.
  Lighting(std::span<const Light> lights, const SampledLights& sampled, const glm::dvec3& up, bool grey);

  [[nodiscard]] std::size_t lights() const { return first_.size() - 1; }

  /// Adds nothing up: the linear light of each light at a place, from its points on the eye's side of a face.
  /// @param normal of length 1, turned to the eye already
  /// @param sides of each point, which side of the face it is on: above 0, below 0, or 0 for edge-on
  /// @param eye_side which side the eye is on, likewise
  /// @param out of each light
  void arriving(const glm::dvec3& point, const glm::dvec3& normal, std::span<const std::int8_t> sides, int eye_side,
                std::span<glm::dvec3> out) const;

  /// Displayed colour, 0 .. 255 a channel, of a surface on which this light, that of all lights, arrives; ambient light
  /// comes to it. The normal is turned to the eye.
  [[nodiscard]] glm::dvec3 displayed(const glm::dvec3& normal, const glm::dvec3& base, const glm::dvec3& light) const;

  /// The linear light that such a surface shows of ambient light alone, or of light that arrives: 1 is white.
  [[nodiscard]] glm::dvec3 shown_of_ambient(const glm::dvec3& normal, const glm::dvec3& base) const;
  [[nodiscard]] glm::dvec3 shown_of(const glm::dvec3& base, const glm::dvec3& light) const;

  /// Displayed colour of a surface that shows its base colour whatever light falls on it.
  [[nodiscard]] static glm::dvec3 displayed_unlit(const glm::dvec3& base, bool grey);

  /// Whether what arrives() from points on the eye's side depends on the place.
  [[nodiscard]] bool depends_on_place(std::span<const std::int8_t> sides, int eye_side) const;

 private:
  std::vector<Light> points_;         // each as a light of its own, with its part of the colour
  std::vector<std::uint32_t> first_;  // of each light into points_, and their number
  glm::dvec3 up_;
  bool grey_;
};

}  // namespace kage
