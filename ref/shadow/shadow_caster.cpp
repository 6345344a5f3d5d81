// SPDX-License-Identifier: Apache-2.0
#include "shadow/shadow_caster.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kage {
namespace {

// Volumes reach past everything by this much, so that rounding leaves nothing between their far end and the last
// receiver.
constexpr double kMargin = 1.01;
// A face is edge-on to a point light nearer to its plane than this share of the light's distance to the furthest
// vertex.
constexpr double kEdgeOn = 1e-9;

double length(const glm::dvec3& v) { return std::sqrt(glm::dot(v, v)); }

struct Box {
  glm::dvec3 low{INFINITY, INFINITY, INFINITY};
  glm::dvec3 high{-INFINITY, -INFINITY, -INFINITY};

  void add(const glm::dvec3& p) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  [[nodiscard]] bool contains(const glm::dvec3& p) const {
    for (int i = 0; i < 3; ++i)
      if (p[i] < low[i] || p[i] > high[i]) return false;
    return true;
  }
};

}  // namespace

ShadowCaster::ShadowCaster(const SceneFrame& frame, const LightPoint& light, std::span<const glm::dvec3> near_corners,
                           double extrusion)
    : frame_(&frame), light_(light) {
  Box box;
  double distance = 0;
  const auto add = [&](const glm::dvec3& p) {
    box.add(p);
    distance = std::max(distance, length(p - light.position));
  };
  for (const glm::dvec3& p : frame.vertices) add(p);
  // What is edge-on is the scene's matter, not the camera's.
  edge_on_ = light.directional ? kEdgeOn : kEdgeOn * distance;
  for (const glm::dvec3& p : near_corners) add(p);
  reach_ = (light.directional ? length(box.high - box.low) : distance) * kMargin * extrusion;
}

double ShadowCaster::light_distance(const Polygon& p) const {
  const Triangle& t = frame_->triangles[p.triangle];
  const glm::dvec3& a = frame_->vertices[t.vertex[0]];
  glm::dvec3 u = frame_->vertices[t.vertex[1]] - a;
  glm::dvec3 v = frame_->vertices[t.vertex[2]] - a;
  // Scaled so that neither products nor squares leave the range of doubles, however large or small the scene is.
  const double scale =
      std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z), std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(scale > 0)) return 0;
  u /= scale;
  v /= scale;
  const glm::dvec3 normal = glm::cross(u, v);
  const double n = length(normal);
  if (!(n > 0)) return 0;
  return light_.directional ? -glm::dot(normal, light_.direction) / n : glm::dot(normal, light_.position - a) / n;
}

int ShadowCaster::facing(const Polygon& p) const {
  const double d = light_distance(p);
  return d > edge_on_ ? 1 : d < -edge_on_ ? -1 : 0;
}

bool ShadowCaster::light_outside(const Component& part) const {
  if (light_.directional) return true;
  // Outside the box is surely outside; within it a component is treated as if the light were inside, which is right as
  // well.
  Box box;
  for (std::uint32_t t = part.first; t < part.first + part.count; ++t)
    for (const std::uint32_t v : frame_->triangles[t].vertex) box.add(frame_->vertices[v]);
  return !box.contains(light_.position);
}

glm::dvec3 ShadowCaster::far_point(const glm::dvec3& p, double factor) const {
  return light_.directional ? p + light_.direction * factor : light_.position + (p - light_.position) * factor;
}

// Directional: the length of the volume. Point: a point of the shadow of a face at distance d from the light's plane is
// at most reach / d times as far from the light as the face is along its ray.
double ShadowCaster::far_factor(std::span<const CapFace> caps) const {
  if (light_.directional) return reach_;
  double nearest = INFINITY;
  for (const CapFace& cap : caps) nearest = std::min(nearest, std::abs(light_distance(frame_->polygons[cap.polygon])));
  return std::max(reach_ / nearest, kMargin);
}

void ShadowCaster::caps(const Component& part, std::vector<CapFace>& out) const {
  out.clear();
  const bool lit_only = part.closed && light_outside(part);
  for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
    const int side = facing(frame_->polygons[i]);
    if (side > 0 || (side < 0 && !lit_only)) out.push_back({i, side < 0});
  }
}

}  // namespace kage
