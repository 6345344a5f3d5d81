// SPDX-License-Identifier: Apache-2.0
//
// Which casters can shadow anything that is seen.
#pragma once

#include <span>
#include <vector>

#include "kage/scene.hpp"
#include "scene/space.hpp"

namespace kage {

/// The parts of a frame's faces that lie in the picture, which may receive shadow.
class Receivers {
 public:
  /// `boxes`: of its components. `near`: nothing that is seen lies nearer. `translucent`: whether translucent faces are
  /// drawn opaque, and take shadow. Refers to `frame` and `boxes`.
  Receivers(const SceneFrame& frame, std::span<const SpaceBox> boxes, double near, int width, int height,
            bool translucent);

  /// By component: false only if its shadow, without end, meets nothing that is seen. A shadow is left out if it lies
  /// beyond a plane that has all seen parts on its other side. These planes are tried: those of the picture, those of
  /// the box round the seen parts, and those of the box round them as the light sees it.
  [[nodiscard]] std::vector<bool> reached(const LightPoint& light) const;

 private:
  /// normal . p <= limit for all that is seen.
  struct HalfSpace {
    glm::dvec3 normal;
    double limit;
  };

  void add_picture(double near, int width, int height);
  void see(std::span<const std::uint32_t> outline);
  void add_bound(const glm::dvec3& normal, std::vector<HalfSpace>& to) const;
  [[nodiscard]] static bool beyond(const HalfSpace& s, const SpaceBox& b, const LightPoint& light);

  const SceneFrame* frame_;
  std::vector<HalfSpace> planes_;
  std::span<const SpaceBox> boxes_;
  std::vector<glm::dvec3> seen_;  // corners of what is; of whole faces each vertex once
  std::vector<bool> known_;       // of vertices: in seen_
  glm::dvec3 sum_{0, 0, 0};       // of the corners of all faces
  std::size_t corners_ = 0;       // so many
  double size_ = 0;               // the largest coordinate of seen_
  std::vector<glm::dvec3> polygon_;
  std::vector<glm::dvec3> buffer_;
};

}  // namespace kage
