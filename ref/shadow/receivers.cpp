// SPDX-License-Identifier: Apache-2.0
#include "shadow/receivers.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace kage {
namespace {

// The picture is taken to be this much wider: more than a pixel of the narrowest that is worth leaving shadows out of,
// and than any rounding.
constexpr double kWider = 1.05;
// Share of the largest coordinate by which planes stand back from what they bound.
constexpr double kReceiverMargin = 1e-6;

}  // namespace

Receivers::Receivers(const SceneFrame& frame, std::span<const SpaceBox> boxes, double near, int width, int height,
                     bool translucent)
    : frame_(&frame), boxes_(boxes), known_(frame.vertices.size(), false) {
  add_picture(near, width, height);
  for (const Component& part : frame.components)
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i)
      if (translucent || !part.translucent) see(frame.outline(frame.polygons[i]));
  for (int i = 0; i < 3; ++i)
    for (const double s : {-1.0, 1.0}) {
      glm::dvec3 normal{0, 0, 0};
      normal[i] = s;
      add_bound(normal, planes_);
    }
}

void Receivers::add_picture(double near, int width, int height) {
  const Camera& c = frame_->camera;
  const double up = c.half_height * kWider;
  const double right = up * width / height;
  const auto add = [&](const glm::dvec3& side, double half) {
    const glm::dvec3 normal = c.perspective ? side - half * c.forward : side;
    planes_.push_back({normal, glm::dot(normal, c.eye) + (c.perspective ? 0 : half)});
  };
  add(c.right, right);
  add(-c.right, right);
  add(c.up, up);
  add(-c.up, up);
  planes_.push_back({-c.forward, -glm::dot(c.forward, c.eye) - near / kWider});
}

// Cut the polygon by the picture's planes, and take note of the corners that are left.
void Receivers::see(std::span<const std::uint32_t> outline) {
  polygon_.clear();
  for (const std::uint32_t v : outline) polygon_.push_back(frame_->vertices[v]);
  bool whole = true;
  for (const HalfSpace& s : planes_) {
    const auto outside = [&s](const glm::dvec3& p) { return glm::dot(s.normal, p) - s.limit; };
    if (std::all_of(polygon_.begin(), polygon_.end(), [&](const glm::dvec3& p) { return outside(p) <= 0; })) continue;
    whole = false;
    buffer_.clear();
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      const glm::dvec3& a = polygon_[i];
      const glm::dvec3& b = polygon_[i + 1 == polygon_.size() ? 0 : i + 1];
      const double da = outside(a);
      const double db = outside(b);
      if (da <= 0) buffer_.push_back(a);
      if ((da <= 0) != (db <= 0)) buffer_.push_back(a + da / (da - db) * (b - a));
    }
    polygon_.swap(buffer_);
    if (polygon_.empty()) return;
  }
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    sum_ += polygon_[i];
    if (whole && known_[outline[i]]) continue;
    if (whole) known_[outline[i]] = true;
    seen_.push_back(polygon_[i]);
    size_ = std::max(size_, largest(polygon_[i]));
  }
  corners_ += polygon_.size();
}

void Receivers::add_bound(const glm::dvec3& normal, std::vector<HalfSpace>& to) const {
  double limit = -INFINITY;
  for (const glm::dvec3& p : seen_) limit = std::max(limit, glm::dot(normal, p));
  to.push_back({normal, limit + kReceiverMargin * size_});
}

// The shadow of a body's box is beyond if the box is, and the light goes no nearer from there.
bool Receivers::beyond(const HalfSpace& s, const SpaceBox& b, const LightPoint& light) {
  const double margin = kReceiverMargin * std::max(largest(b.low), largest(b.high));
  for (unsigned i = 0; i < 8; ++i) {
    const glm::dvec3 p = b.corner(i);
    const glm::dvec3 way = light.directional ? light.direction : p - light.position;
    // Margins on both: a volume's sides are as far off as rounding may turn the way.
    if (!(glm::dot(s.normal, p) > s.limit + margin) || !(glm::dot(s.normal, way) >= 0)) return false;
  }
  return true;
}

std::vector<bool> Receivers::reached(const LightPoint& light) const {
  std::vector<bool> out(frame_->components.size(), false);
  if (seen_.empty()) return out;
  std::vector<HalfSpace> planes = planes_;
  glm::dvec3 ahead = light.direction;
  if (!light.directional) ahead = sum_ / static_cast<double>(corners_) - light.position;
  const double distance = length(ahead);
  if (distance > 0) {
    ahead /= distance;
    const glm::dvec3 other = std::abs(ahead.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    glm::dvec3 right = glm::cross(ahead, other);
    right /= length(right);
    const glm::dvec3 up = glm::cross(right, ahead);
    add_bound(ahead, planes);
    for (const glm::dvec3& side : {right, -right, up, -up}) {
      if (light.directional) {
        add_bound(side, planes);
        continue;
      }
      // Through the light, and as steep as what is seen goes to that side. Nothing may be beside or behind the light.
      double slope = -INFINITY;
      bool before = true;
      for (const glm::dvec3& p : seen_) {
        const glm::dvec3 d = p - light.position;
        const double along = glm::dot(d, ahead);
        before = before && along > 1e-3 * length(d);
        slope = std::max(slope, glm::dot(d, side) / along);
      }
      const glm::dvec3 normal = side - (slope + kReceiverMargin * (1 + std::abs(slope))) * ahead;
      if (before) planes.push_back({normal, glm::dot(normal, light.position)});
    }
  }
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] = !frame_->components[c].translucent && std::none_of(planes.begin(), planes.end(), [&](const HalfSpace& s) {
      return beyond(s, boxes_[c], light);
    });
  return out;
}

}  // namespace kage
