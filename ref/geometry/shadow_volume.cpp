// SPDX-License-Identifier: Apache-2.0
#include "geometry/shadow_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

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

ShadowCaster::ShadowCaster(const SceneFrame& frame, std::span<const glm::dvec3> near_corners, double extrusion)
    : frame_(&frame) {
  const Light& light = frame.light;
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

double ShadowCaster::light_distance(const Triangle& t) const {
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
  return frame_->light.directional ? -glm::dot(normal, frame_->light.direction) / n
                                   : glm::dot(normal, frame_->light.position - a) / n;
}

int ShadowCaster::facing(const Triangle& t) const {
  const double d = light_distance(t);
  return d > edge_on_ ? 1 : d < -edge_on_ ? -1 : 0;
}

bool ShadowCaster::light_outside(const Component& part) const {
  if (frame_->light.directional) return true;
  // Outside the box is surely outside; within it a component is treated as if the light were inside, which is right as
  // well.
  Box box;
  for (std::uint32_t t = part.first; t < part.first + part.count; ++t)
    for (const std::uint32_t v : frame_->triangles[t].vertex) box.add(frame_->vertices[v]);
  return !box.contains(frame_->light.position);
}

glm::dvec3 ShadowCaster::far_point(const glm::dvec3& p, double factor) const {
  return frame_->light.directional ? p + frame_->light.direction * factor
                                   : frame_->light.position + (p - frame_->light.position) * factor;
}

// Directional: the length of the volume. Point: a point of the shadow of a face at distance d from the light's plane is
// at most reach / d times as far from the light as the face is along its ray.
double ShadowCaster::far_factor(double distance) const {
  return frame_->light.directional ? reach_ : std::max(reach_ / distance, kMargin);
}

bool ShadowCaster::make_convex(const Component& part, WorldVolume& v) const {
  v.clear();
  // A border edge is one of a lit face whose twin is not a lit face's.
  std::unordered_map<std::uint64_t, int> lit_edges;
  const auto key = [](std::uint32_t a, std::uint32_t b) { return static_cast<std::uint64_t>(a) << 32 | b; };
  double nearest = INFINITY;
  for (std::uint32_t t = part.first; t < part.first + part.count; ++t) {
    const Triangle& triangle = frame_->triangles[t];
    if (facing(triangle) <= 0) continue;
    v.caps.push_back({t, false});
    nearest = std::min(nearest, light_distance(triangle));
    for (std::size_t i = 0; i < 3; ++i) ++lit_edges[key(triangle.vertex[i], triangle.vertex[(i + 1) % 3])];
  }
  if (v.caps.empty()) return false;
  const double factor = far_factor(nearest);
  for (const CapFace& cap : v.caps) {
    const Triangle& triangle = frame_->triangles[cap.triangle];
    std::array<glm::dvec3, 3> far{};
    for (std::size_t i = 0; i < 3; ++i) far[i] = far_point(frame_->vertices[triangle.vertex[i]], factor);
    v.far_end.push_back({far[0], far[2], far[1]});
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (lit_edges.count(key(triangle.vertex[j], triangle.vertex[i])) != 0) continue;
      v.sides.push_back({frame_->vertices[triangle.vertex[i]], frame_->vertices[triangle.vertex[j]], far[i], far[j]});
    }
  }
  return true;
}

bool ShadowCaster::make_face(std::uint32_t index, bool lit_only, WorldVolume& v) const {
  const Triangle& triangle = frame_->triangles[index];
  const int side = facing(triangle);
  if (side == 0 || (lit_only && side < 0)) return false;
  v.clear();
  v.caps.push_back({index, side < 0});
  const double factor = far_factor(std::abs(light_distance(triangle)));
  std::array<glm::dvec3, 3> near{};
  std::array<glm::dvec3, 3> far{};
  for (std::size_t i = 0; i < 3; ++i) {
    near[i] = frame_->vertices[triangle.vertex[side < 0 ? 2 - i : i]];
    far[i] = far_point(near[i], factor);
  }
  v.far_end.push_back({far[0], far[2], far[1]});
  for (std::size_t i = 0; i < 3; ++i) v.sides.push_back({near[i], near[(i + 1) % 3], far[i], far[(i + 1) % 3]});
  return true;
}

}  // namespace kage
