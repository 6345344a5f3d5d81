// SPDX-License-Identifier: Apache-2.0
//
// Shadow volumes in world space: which faces are caps, which polygons are sides.
//
// A volume is closed: caps (faces of the caster, turned to the light), sides (from the caps' border edges away from the
// light) and a far end. The far end is further from the light than everything drawn and than the picture's corners on
// the near plane, hence than every point between eye and surface; so it hides no pixel and is never a span. It counts
// where the near plane cuts it. [Matsumoto, section 2; parity needs volumes that cover no point twice: a convex
// solid's, or a single face's.]
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

/// A cap: a polygon of the frame. `turned`: its own outside looks away from the light, so that it bounds the volume the
/// other way.
struct CapFace {
  std::uint32_t polygon = 0;
  bool turned = false;
};

/// A side from the edge (a, b) of a cap to (far_b, far_a); outward as written: a, far_a, far_b, b is counter-clockwise
/// from outside.
struct SideFace {
  std::uint32_t polygon = 0;  ///< the cap
  glm::dvec3 a, b, far_a, far_b;
};

struct WorldVolume {
  std::vector<CapFace> caps;
  std::vector<SideFace> sides;
  std::vector<std::vector<glm::dvec3>> far_end;  ///< outward
  std::uint32_t component = 0;

  void clear() {
    caps.clear();
    sides.clear();
    far_end.clear();
  }
};

/// Casts the shadows of one frame that one point of a light makes.
class ShadowCaster {
 public:
  /// `near_corners`: the picture's corners on the near plane; volumes reach past them too. `extrusion`: how many times
  /// as far as they must volumes reach, >= 1.
  ShadowCaster(const SceneFrame& frame, const LightPoint& light, std::span<const glm::dvec3> near_corners,
               double extrusion);

  /// The polygon's side of the light: > 0 lit from outside, < 0 from inside, 0 within rounding of edge-on (casts
  /// nothing).
  [[nodiscard]] int facing(const Polygon& p) const;

  /// Call `emit` with every volume, in order of components and polygons.
  template <class Emit>
  void each(Emit emit) const {
    WorldVolume v;
    for (std::size_t c = 0; c < frame_->components.size(); ++c) {
      const Component& part = frame_->components[c];
      if (part.translucent) continue;
      v.component = static_cast<std::uint32_t>(c);
      if (part.convex && light_outside(part) && make_convex(part, v)) {
        emit(static_cast<const WorldVolume&>(v));
        continue;
      }
      const bool lit_only = part.closed && light_outside(part);
      for (std::uint32_t p = part.first_polygon; p < part.first_polygon + part.polygon_count; ++p)
        if (make_face(p, lit_only, v)) emit(static_cast<const WorldVolume&>(v));
    }
  }

 private:
  [[nodiscard]] bool light_outside(const Component& part) const;
  [[nodiscard]] bool make_convex(const Component& part, WorldVolume& v) const;
  [[nodiscard]] bool make_face(std::uint32_t index, bool lit_only, WorldVolume& v) const;
  template <class Border>
  void extrude(std::span<const std::uint32_t> corners, const CapFace& cap, double factor, WorldVolume& v,
               Border border) const;
  [[nodiscard]] double light_distance(const Polygon& p) const;
  [[nodiscard]] glm::dvec3 far_point(const glm::dvec3& p, double factor) const;
  [[nodiscard]] double far_factor(double distance) const;

  const SceneFrame* frame_;
  LightPoint light_;
  double edge_on_;  // a face whose plane is no further from the light is edge-on
  // No two points of the scene and the near corners (directional), or one of them and the light (point), are further
  // apart.
  double reach_;
};

}  // namespace kage
