// SPDX-License-Identifier: Apache-2.0
//
// The space where a scene's frames are computed: the scene is near the origin and of middling size there, wherever the
// file puts it and however long its unit is. So doubles tell its positions apart, and products of lengths neither
// vanish nor overflow.
#pragma once

#include <vector>

#include "raw.hpp"
#include "space.hpp"

namespace kage::scene {

/// A point p of the file's world lies at (p - origin) 2^-exponent. The scaling is exact.
struct WorkingFrame {
  glm::dvec3 origin{0, 0, 0};
  int exponent = 0;

  [[nodiscard]] bool is_moved() const { return origin != glm::dvec3{0, 0, 0}; }

  /// A length of the file, here.
  [[nodiscard]] double length(double of_file) const;
};

/// Where the origin of a scene with this box is: the world's, unless the scene is 2^12 times as far from it as it is
/// large; then the middle of the box.
glm::dvec3 working_origin(const SpaceBox& box);

/// The exponent of a scene with this box: 0, unless it is longer than 2^65 or shorter than 2^-64; then the one that
/// makes its length 1 to 2.
int working_exponent(const SpaceBox& box);

/// Object-to-world maps of all nodes, in the working frame. `own`: of each node relative to its parent. Where the frame
/// has an origin of its own, places of nodes are summed up in pairs of doubles. So objects that lie close together, far
/// from the world's origin, keep all digits of the file's numbers.
std::vector<Affine> placed(const RawScene& scene, const std::vector<Affine>& own, const WorkingFrame& frame);

}  // namespace kage::scene
