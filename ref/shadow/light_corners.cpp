// SPDX-License-Identifier: Apache-2.0
#include "shadow/light_corners.hpp"

#include <algorithm>

#include "order/exact.hpp"
#include "order/filter.hpp"
#include "scene/space.hpp"

namespace kage {
namespace {

OrderPoint order_point(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

// Beyond these neither squares nor cubes of the coordinates can be trusted to stay doubles.
constexpr double kLeast = 0x1p-300;
constexpr double kMost = 0x1p300;

}  // namespace

LightCorners::LightCorners(const SceneFrame& frame, const LightPoint& light, std::span<const CapFace> caps)
    : frame_(&frame), light_(light) {
  first_.reserve(caps.size() + 1);
  first_.push_back(0);
  for (const CapFace& cap : caps) {
    const auto corners = frame.outline(frame.polygons[cap.polygon]);
    vertex_.insert(vertex_.end(), corners.begin(), corners.end());
    if (cap.turned) std::reverse(vertex_.end() - static_cast<std::ptrdiff_t>(corners.size()), vertex_.end());
    first_.push_back(static_cast<std::uint32_t>(vertex_.size()));
  }
  at_.reserve(vertex_.size());
  double most = 0;
  if (light.directional) {
    const glm::dvec3& l = light.direction;
    int z = 0;
    for (const int i : {1, 2})
      if (std::abs(l[i]) > std::abs(l[z])) z = i;
    const int x = (z + 1) % 3;
    const int y = (z + 2) % 3;
    const double s = l[x] / l[z];
    const double t = l[y] / l[z];
    for (const std::uint32_t v : vertex_) {
      const glm::dvec3& p = frame.vertices[v];
      most = std::max(most, largest(p));
      at_.emplace_back(p[x] - s * p[z], p[y] - t * p[z], 0);
    }
    sign_ = l[z] < 0 ? 1 : -1;
    limit_ = 0x1p-44 * most * most;
  } else {
    for (const std::uint32_t v : vertex_) {
      at_.push_back(frame.vertices[v] - light.position);
      most = std::max(most, largest(at_.back()));
    }
    limit_ = 0x1p-46 * most * most * most;
  }
  if (!(most > kLeast && most < kMost)) limit_ = INFINITY;
}

int LightCorners::exact_turn(std::uint32_t p, std::uint32_t q, std::uint32_t r) const {
  return light_turn(*frame_, light_, vertex_[p], vertex_[q], vertex_[r]);
}

int light_turn(const SceneFrame& frame, const LightPoint& light, std::uint32_t p, std::uint32_t q, std::uint32_t r) {
  if (p == q || q == r || r == p) return 0;
  const order::PlanePoints plane{order_point(frame.vertices[p]), order_point(frame.vertices[q]),
                                 order_point(frame.vertices[r])};
  const order::FilterPlane filter(plane.a, plane.b, plane.c);
  if (light.directional) {
    const OrderPoint to = order_point(-light.direction);
    const double s = filter.slope(to);
    if (std::abs(s) > filter.slope_error(to)) return s > 0 ? 1 : -1;
    return order::exact_facing(plane, to);
  }
  const OrderPoint at = order_point(light.position);
  const double s = filter.value(at);
  if (std::abs(s) > filter.error(at)) return s > 0 ? 1 : -1;
  return order::exact_side(plane, at);
}

}  // namespace kage
