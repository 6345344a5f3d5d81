// SPDX-License-Identifier: Apache-2.0
#include "shadow/shadow_caster.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kage {
namespace {

// Volumes reach past everything by this much, so that rounding leaves nothing between their far end and the last
// receiver.
constexpr double kExtrusionMargin = 1.01;
// A face is edge-on to a point light nearer to its plane than this share of the light's distance to the furthest
// vertex.
constexpr double kEdgeOn = 1e-9;
// More than all roundings of a distance.
constexpr double kRounding = 1e-9;

double furthest(const glm::dvec3& from, std::span<const glm::dvec3> points) {
  double most = 0;
  for (const glm::dvec3& p : points) most = std::max(most, squared(p - from));
  return std::sqrt(most);
}

// Points that include, for each of `from`, the point furthest from it. A point is left out if, seen from from[0], it is
// nearer than the furthest by more than twice the spread of `from`: then it is nearer for the others too.
std::vector<glm::dvec3> far_ones(std::span<const LightPoint> from, std::span<const glm::dvec3> points) {
  double spread = 0;
  for (const LightPoint& l : from) spread = std::max(spread, length(l.position - from[0].position));
  const double least = furthest(from[0].position, points) * (1 - kRounding) - 2 * spread;
  std::vector<glm::dvec3> out;
  for (const glm::dvec3& p : points)
    if (!(length(p - from[0].position) < least)) out.push_back(p);
  return out;
}

}  // namespace

std::vector<SpaceBox> component_boxes(const SceneFrame& frame) {
  std::vector<SpaceBox> boxes(frame.components.size());
  for (std::size_t c = 0; c < boxes.size(); ++c) {
    const Component& part = frame.components[c];
    for (std::uint32_t t = part.first; t < part.first + part.count; ++t)
      for (const std::uint32_t v : frame.triangles[t].vertex) boxes[c].add(frame.vertices[v]);
  }
  return boxes;
}

FacePlane::FacePlane(const SceneFrame& frame, const Polygon& p) {
  const Triangle& t = frame.triangles[p.triangle];
  point = frame.vertices[t.vertex[0]];
  glm::dvec3 u = frame.vertices[t.vertex[1]] - point;
  glm::dvec3 v = frame.vertices[t.vertex[2]] - point;
  // Scaled so that neither products nor squares leave the range of doubles, however large or small the scene is.
  const double scale = std::max(largest(u), largest(v));
  if (!(scale > 0)) return;
  u /= scale;
  v /= scale;
  normal = glm::cross(u, v);
  normal_length = length(normal);
}

ShadowCaster::ShadowCaster(const SceneFrame& frame, const LightPoint& light, std::span<const glm::dvec3> near_corners,
                           double extrusion)
    : ShadowCaster(of_points(frame, std::span(&light, 1), near_corners, extrusion)[0]) {}

std::vector<ShadowCaster> ShadowCaster::of_points(const SceneFrame& frame, std::span<const LightPoint> points,
                                                  std::span<const glm::dvec3> near_corners, double extrusion) {
  std::vector<ShadowCaster> casters;
  casters.reserve(points.size());
  // The bound for edge-on faces follows from the scene, not from the camera.
  if (points[0].directional) {
    SpaceBox box;
    for (const glm::dvec3& p : frame.vertices) box.add(p);
    for (const glm::dvec3& p : near_corners) box.add(p);
    for (const LightPoint& l : points)
      casters.push_back({kEdgeOn, box.diagonal() * kExtrusionMargin * extrusion, frame, l});
    return casters;
  }
  std::vector<glm::dvec3> few;
  if (points.size() > 1) few = far_ones(points, frame.vertices);
  const std::span<const glm::dvec3> far = points.size() > 1 ? few : frame.vertices;
  for (const LightPoint& l : points) {
    const double distance = furthest(l.position, far);
    const double reach = std::max(distance, furthest(l.position, near_corners));
    casters.push_back({kEdgeOn * distance, reach * kExtrusionMargin * extrusion, frame, l});
  }
  return casters;
}

double ShadowCaster::light_distance(const FacePlane& face) const {
  if (!(face.normal_length > 0)) return 0;
  return light_.directional ? -glm::dot(face.normal, light_.direction) / face.normal_length
                            : glm::dot(face.normal, light_.position - face.point) / face.normal_length;
}

int ShadowCaster::facing(const FacePlane& face) const {
  const double d = light_distance(face);
  return d > edge_on_ ? 1 : d < -edge_on_ ? -1 : 0;
}

glm::dvec3 ShadowCaster::far_point(const glm::dvec3& p, double factor) const {
  return light_.directional ? p + light_.direction * factor : light_.position + (p - light_.position) * factor;
}

// Directional: the length of the volume. Point: a point of the shadow of a face at distance d from the light's plane is
// at most reach / d times as far from the light as the face is along its ray.
double ShadowCaster::far_factor(std::span<const CapFace> caps) const {
  if (light_.directional) return reach_;
  double nearest = INFINITY;
  for (const CapFace& cap : caps)
    nearest = std::min(nearest, std::abs(light_distance(FacePlane(*frame_, frame_->polygons[cap.polygon]))));
  return std::max(reach_ / nearest, kExtrusionMargin);
}

// Outside the box is surely outside; within it a component is treated as if the light were inside, which is right as
// well.
void ShadowCaster::caps(const Component& part, const SpaceBox& box, std::vector<CapFace>& out) const {
  out.clear();
  const bool lit_only = part.closed && light_outside(box);
  for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
    const int side = facing(frame_->polygons[i]);
    if (side > 0 || (side < 0 && !lit_only)) out.push_back({i, side < 0});
  }
}

}  // namespace kage
