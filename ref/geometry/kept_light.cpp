// SPDX-License-Identifier: Apache-2.0
#include "geometry/kept_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "shadow/shadow_caster.hpp"

namespace kage {
namespace {

// Boxes times faces, past which the answer is yes: some tenths of a second for each light.
constexpr std::size_t kMostWork = std::size_t{1} << 27U;

// A component no more than this part of its size before a face lies in the face's plane.
constexpr double kFlat = 1e-9;

/// Whether a way, of `length` times `along`, comes nearer to the box than `radius` in each coordinate.
bool meets(const SpaceBox& box, const glm::dvec3& from, const glm::dvec3& along, double length, double radius) {
  double enters = 0;
  double leaves = length;
  for (int i = 0; i < 3; ++i) {
    const double low = box.low[i] - radius - from[i];
    const double high = box.high[i] + radius - from[i];
    if (along[i] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double first = low / along[i];
    const double last = high / along[i];
    enters = std::max(enters, std::min(first, last));
    leaves = std::min(leaves, std::max(first, last));
  }
  return enters <= leaves;
}

/// No corner of the box lies before the plane.
bool is_behind(const SpaceBox& box, const glm::dvec3& point, const glm::dvec3& normal) {
  for (unsigned i = 0; i < 8; ++i)
    if (glm::dot(box.corner(i) - point, normal) > kFlat * box.diagonal()) return false;
  return true;
}

}  // namespace

KeptLight::KeptLight(const SceneFrame& frame)
    : frame_(&frame),
      boxes_(component_boxes(frame)),
      all_(frame.polygons.size() > kMostWork / std::max<std::size_t>(frame.components.size(), 1)) {}

bool KeptLight::may_be(std::uint32_t polygon, const Component& part, int eye_side, const Light& light) const {
  if (all_) return true;
  const Polygon& face = frame_->polygons[polygon];
  const auto outline = frame_->outline(face);
  glm::dvec3 middle{0, 0, 0};
  for (const std::uint32_t v : outline) middle += frame_->vertices[v] / static_cast<double>(outline.size());
  double radius = 0;
  for (const std::uint32_t v : outline) radius = std::max(radius, glm::length(frame_->vertices[v] - middle));
  if (light.shape != LightShape::point)
    radius = std::max(radius, glm::length(light.axis_u) + glm::length(light.axis_v));
  const glm::dvec3 along = light.directional ? -light.direction : light.position - middle;
  const double length = light.directional ? std::numeric_limits<double>::max() : 1;
  const FacePlane plane(*frame_, face);
  const glm::dvec3 normal = plane.normal * (eye_side / plane.normal_length);
  for (std::size_t c = 0; c < boxes_.size(); ++c) {
    const Component& caster = frame_->components[c];
    const bool own = &caster == &part;
    if (caster.translucent || (own && caster.convex)) continue;
    // Light comes from before the face, and so do those that keep it.
    if ((own || meets(boxes_[c], middle, along, length, radius)) &&
        !(plane.normal_length > 0 && is_behind(boxes_[c], middle, normal)))
      return true;
  }
  return false;
}

}  // namespace kage
