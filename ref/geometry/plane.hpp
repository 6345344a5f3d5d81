// SPDX-License-Identifier: Apache-2.0
//
// The depth plane through three snapped vertices, in integers. Two polygons that share a snapped edge, and its two
// depths, then have planes that meet exactly on that edge: on either side of it the nearer one is nearer, however steep
// they are.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kage/geometry.hpp"

namespace kage {

/// Fraction bits of a vertex's depth.
inline constexpr int kVertexFrac = 16;

/// A snapped vertex with its depth, rounded to 2^-16 LSB.
struct DepthVertex {
  ScreenVertex at;
  std::int64_t z = 0;
};

/// The vertex on a plane at a snapped position, rounded to nearest and held within +-2^28 LSB.
DepthVertex on_plane(const ScreenPlane& plane, const ScreenVertex& at);

/// Twice the signed area of a snapped triangle, in subpixels squared; 0 if it has none.
std::int64_t double_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c);

/// The plane through three vertices, each coefficient rounded to nearest. Empty if they have no area, or if the plane
/// is steeper than 2^36 LSB a pixel.
std::optional<ScreenPlane> plane_through(const std::array<DepthVertex, 3>& v);

}  // namespace kage
