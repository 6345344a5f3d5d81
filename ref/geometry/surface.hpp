// SPDX-License-Identifier: Apache-2.0
//
// Places of a face: where light is worked out.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

/// An edge is longer than another by more than rounding if its length, or the square of that, is so many times the
/// other's: so a face is parted alike in any unit of length.
inline constexpr double kLonger = 1 + 0x1p-20;

/// A place of a face, with what its light follows from.
struct SurfacePoint {
  glm::dvec3 point;
  glm::dvec3 normal;  ///< out of the face, of length 1
  glm::dvec3 base;    ///< colour, linear
};

/// The face of a polygon of the frame, to which it refers. Normals and colours of a triangle's corners are shared out
/// by area within it; more corners than three share one look.
class FaceSurface {
 public:
  FaceSurface(const SceneFrame& frame, std::uint32_t polygon)
      : frame_(&frame),
        triangle_(&frame.triangles[frame.polygons[polygon].triangle]),
        outline_(frame.outline(frame.polygons[polygon])) {
    const auto& s = triangle_->shading;
    alike_ = outline_.size() > 3 || (s[0] == s[1] && s[0] == s[2]);
    origin_ = frame.vertices[outline_[0]];
    u_ = frame.vertices[outline_[1]] - origin_;
    v_ = frame.vertices[outline_[2]] - origin_;
    // In units of the longest of their numbers, whose fourth power is neither 0 nor infinite.
    for (int k = 0; k < 3; ++k) unit_ = std::max({unit_, std::abs(u_[k]), std::abs(v_[k])});
    if (unit_ > 0) {
      u_ /= unit_;
      v_ /= unit_;
    }
    normal_ = glm::cross(u_, v_);
    squared_ = glm::dot(normal_, normal_);
  }

  [[nodiscard]] std::size_t corners() const { return outline_.size(); }
  [[nodiscard]] bool alike() const { return alike_; }  ///< normal and colour are the same all over it

  [[nodiscard]] SurfacePoint corner(std::size_t i) const {
    const ShadingVertex& v = frame_->shading[triangle_->shading[outline_.size() == 3 ? i : 0]];
    return {frame_->vertices[outline_[i]], v.normal, v.color};
  }

  [[nodiscard]] std::vector<SurfacePoint> outline() const {
    std::vector<SurfacePoint> all;
    for (std::size_t i = 0; i < corners(); ++i) all.push_back(corner(i));
    return all;
  }

  /// Any place of the face, which is a triangle or alike all over. A triangle without area looks as at its first
  /// corner.
  [[nodiscard]] SurfacePoint at(const glm::dvec3& point) const {
    const ShadingVertex& first = frame_->shading[triangle_->shading[0]];
    SurfacePoint p{point, first.normal, first.color};
    if (alike_ || !(squared_ > 0)) return p;
    const glm::dvec3 from = (point - origin_) / unit_;
    const double b = glm::dot(glm::cross(from, v_), normal_) / squared_;
    const double c = glm::dot(glm::cross(u_, from), normal_) / squared_;
    const std::array<double, 3> part{1 - b - c, b, c};
    glm::dvec3 normal{0, 0, 0};
    p.base = {0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      const ShadingVertex& s = frame_->shading[triangle_->shading[i]];
      normal += s.normal * part[i];
      p.base += s.color * part[i];
    }
    const double length = glm::length(normal);
    if (length > 0) p.normal = normal / length;
    return p;
  }

 private:
  const SceneFrame* frame_;
  const Triangle* triangle_;
  std::span<const std::uint32_t> outline_;
  bool alike_;
  double unit_ = 0;
  glm::dvec3 origin_;
  glm::dvec3 u_;
  glm::dvec3 v_;
  glm::dvec3 normal_;
  double squared_;
};

}  // namespace kage
