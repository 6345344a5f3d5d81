// SPDX-License-Identifier: Apache-2.0
//
// One point of a light, and how a frame's faces stand to it.
//
// A volume's far end is further from the light than everything drawn and than the picture's corners where depth begins.
// Hence it is further than every point between these and a surface, hides no pixel and is never a span. Its cut where
// depth begins counts.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/space.hpp"
#include "shadow/world_volume.hpp"

namespace kage {

/// For each component the box round its vertices.
std::vector<SpaceBox> component_boxes(const SceneFrame& frame);

/// A plane of a face, as far as lights ask about it.
struct FacePlane {
  FacePlane(const SceneFrame& frame, const Polygon& p);

  glm::dvec3 point;
  glm::dvec3 normal{0, 0, 0};  ///< outward
  double normal_length = 0;    ///< 0 if the face has no area
};

class ShadowCaster {
 public:
  /// Refers to `frame`. `near_corners`: the picture's corners where depth begins; volumes reach past them too.
  /// `extrusion`: how many times as far as they must volumes reach, >= 1.
  ShadowCaster(const SceneFrame& frame, const LightPoint& light, std::span<const glm::dvec3> near_corners,
               double extrusion);

  /// The casters of all points of a light, in order. A vertex far from one of them is far from all, so not every vertex
  /// is looked at for each.
  static std::vector<ShadowCaster> of_points(const SceneFrame& frame, std::span<const LightPoint> points,
                                             std::span<const glm::dvec3> near_corners, double extrusion);

  /// The face's side of the light: > 0 lit from outside, < 0 from inside, 0 within rounding of edge-on (casts nothing).
  [[nodiscard]] int facing(const FacePlane& face) const;
  [[nodiscard]] int facing(const Polygon& p) const { return facing(FacePlane(*frame_, p)); }

  /// Whether the light is surely outside of a component with this box.
  [[nodiscard]] bool light_outside(const SpaceBox& box) const {
    return light_.directional || !box.contains(light_.position);
  }

  /// The faces of a component that cast, turned to the light: of a closed one with the light outside those lit from
  /// outside, else all. `box`: the component's.
  void caps(const Component& part, const SpaceBox& box, std::vector<CapFace>& out) const;

  /// How far the caps' shadow must reach: far_point()'s factor.
  [[nodiscard]] double far_factor(std::span<const CapFace> caps) const;

  /// The point's place at the far end.
  [[nodiscard]] glm::dvec3 far_point(const glm::dvec3& p, double factor) const;

  [[nodiscard]] const LightPoint& light() const { return light_; }
  /// A face whose plane is no further from the light (directional: whose sine is no larger) is edge-on.
  [[nodiscard]] double edge_on() const { return edge_on_; }

 private:
  ShadowCaster(double edge_on, double reach, const SceneFrame& frame, const LightPoint& light)
      : frame_(&frame), light_(light), edge_on_(edge_on), reach_(reach) {}

  [[nodiscard]] double light_distance(const FacePlane& face) const;

  const SceneFrame* frame_;
  LightPoint light_;
  double edge_on_;
  // No two points of the scene and the near corners (directional), or one of them and the light (point), are further
  // apart.
  double reach_;
};

}  // namespace kage
