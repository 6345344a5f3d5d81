// SPDX-License-Identifier: Apache-2.0
//
// From which corner an outline is cut into triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "kage/geometry.hpp"

namespace kage {

/// Twice the area of a triangle, signed by the way that its corners turn.
inline std::int64_t twice_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) - (std::int64_t{c.x} - a.x) * (std::int64_t{b.y} - a.y);
}

/// The first corner of which the triangles with each side of the outline that does not touch it have no pixel twice and
/// none outside the outline. An outline that is convex before it is snapped may be bent by half a step of the snap, so
/// that triangles from corner 0 overlap there. None where no corner will do: the outline is bent in several places.
/// Exact for coordinates within +-2^30.
std::optional<std::size_t> fan_corner(std::span<const ScreenVertex> outline);

}  // namespace kage
