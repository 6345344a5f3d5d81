// SPDX-License-Identifier: Apache-2.0
#include "geometry/shadow_volume.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_set>
#include <utility>

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
double ShadowCaster::far_factor(double distance) const {
  return light_.directional ? reach_ : std::max(reach_ / distance, kMargin);
}

// The far end of a cap whose corners go round it seen from the light, and sides at its border edges.
template <class Border>
void ShadowCaster::extrude(std::span<const std::uint32_t> corners, const CapFace& cap, double factor, WorldVolume& v,
                           Border border) const {
  const std::size_t n = corners.size();
  std::vector<glm::dvec3> far(n);
  for (std::size_t i = 0; i < n; ++i) far[i] = far_point(frame_->vertices[corners[i]], factor);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    if (!border(corners[i], corners[j])) continue;
    v.sides.push_back({cap.polygon, frame_->vertices[corners[i]], frame_->vertices[corners[j]], far[i], far[j]});
  }
  std::reverse(far.begin(), far.end());
  v.far_end.push_back(std::move(far));
}

bool ShadowCaster::make_convex(const Component& part, WorldVolume& v) const {
  v.clear();
  // A border edge is one of a lit face whose twin is not a lit face's.
  std::unordered_set<std::uint64_t> lit_edges;
  const auto key = [](std::uint32_t a, std::uint32_t b) { return static_cast<std::uint64_t>(a) << 32 | b; };
  double nearest = INFINITY;
  for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
    const Polygon& polygon = frame_->polygons[i];
    if (facing(polygon) <= 0) continue;
    v.caps.push_back({i, false});
    nearest = std::min(nearest, light_distance(polygon));
    const auto corners = frame_->outline(polygon);
    for (std::size_t k = 0; k < corners.size(); ++k)
      lit_edges.insert(key(corners[k], corners[(k + 1) % corners.size()]));
  }
  if (v.caps.empty()) return false;
  const double factor = far_factor(nearest);
  for (const CapFace& cap : v.caps)
    extrude(frame_->outline(frame_->polygons[cap.polygon]), cap, factor, v,
            [&](std::uint32_t a, std::uint32_t b) { return lit_edges.count(key(b, a)) == 0; });
  return true;
}

bool ShadowCaster::make_face(std::uint32_t index, bool lit_only, WorldVolume& v) const {
  const Polygon& polygon = frame_->polygons[index];
  const int side = facing(polygon);
  if (side == 0 || (lit_only && side < 0)) return false;
  v.clear();
  const CapFace cap{index, side < 0};
  v.caps.push_back(cap);
  const auto outline = frame_->outline(polygon);
  std::vector<std::uint32_t> corners(outline.begin(), outline.end());
  if (cap.turned) std::reverse(corners.begin(), corners.end());
  extrude(corners, cap, far_factor(std::abs(light_distance(polygon))), v,
          [](std::uint32_t, std::uint32_t) { return true; });
  return true;
}

}  // namespace kage
