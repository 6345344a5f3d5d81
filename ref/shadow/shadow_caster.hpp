// SPDX-License-Identifier: Apache-2.0
//
// One point of a light, and how a frame's faces stand to it.
//
// A volume's far end is further from the light than everything drawn and than the picture's corners on the near plane,
// hence than every point between eye and surface; so it hides no pixel and is never a span. It counts where the near
// plane cuts it.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "shadow/world_volume.hpp"

namespace kage {

class ShadowCaster {
 public:
  /// `near_corners`: the picture's corners on the near plane; volumes reach past them too. `extrusion`: how many times
  /// as far as they must volumes reach, >= 1.
  ShadowCaster(const SceneFrame& frame, const LightPoint& light, std::span<const glm::dvec3> near_corners,
               double extrusion);

  /// The polygon's side of the light: > 0 lit from outside, < 0 from inside, 0 within rounding of edge-on (casts
  /// nothing).
  [[nodiscard]] int facing(const Polygon& p) const;

  /// Whether the light is surely outside of the component.
  [[nodiscard]] bool light_outside(const Component& part) const;

  /// The faces of a component that cast, turned to the light: of a closed one with the light outside those lit from
  /// outside, else all.
  void caps(const Component& part, std::vector<CapFace>& out) const;

  /// How far the caps' shadow must reach: far_point()'s factor.
  [[nodiscard]] double far_factor(std::span<const CapFace> caps) const;

  /// The point's place at the far end.
  [[nodiscard]] glm::dvec3 far_point(const glm::dvec3& p, double factor) const;

  [[nodiscard]] const LightPoint& light() const { return light_; }
  /// A face whose plane is no further from the light (directional: whose sine is no larger) is edge-on.
  [[nodiscard]] double edge_on() const { return edge_on_; }

 private:
  [[nodiscard]] double light_distance(const Polygon& p) const;

  const SceneFrame* frame_;
  LightPoint light_;
  double edge_on_;
  // No two points of the scene and the near corners (directional), or one of them and the light (point), are further
  // apart.
  double reach_;
};

}  // namespace kage
