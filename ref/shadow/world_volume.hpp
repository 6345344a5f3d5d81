// SPDX-License-Identifier: Apache-2.0
//
// Shadow volumes in world space: which faces are caps, which edges have sides.
//
// A volume is the sum of its faces' prisms. Each face is turned to the light and is a cap; its prism goes from there
// away from the light to a far end. Sides of two prisms at one edge cancel where the faces go on over it, and add up
// where they lie on the same side of it. So an edge has one side with a weight: how often the caps have it in one
// direction, less how often in the other. A point counts as many prisms as it lies in, which is the number of caps
// between it and the light. [Matsumoto, section 2, has volumes of weight 1 that cover no point twice.]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kage/scene.hpp"

namespace kage {

/// A cap: a polygon of the frame. `turned`: its own outside looks away from the light, so that it bounds the volume the
/// other way.
struct CapFace {
  std::uint32_t polygon = 0;
  bool turned = false;

  bool operator==(const CapFace&) const = default;
};

/// A side from the edge (a, b) of a cap away from the light; a, far a, far b, b is counter-clockwise from outside.
struct SideEdge {
  std::uint32_t polygon = 0;  ///< the cap, which has the edge from a to b (if it is turned, from b to a)
  std::uint32_t a = 0;        ///< into SceneFrame::vertices
  std::uint32_t b = 0;
  std::int32_t w = 1;  ///< > 0: so many sides in one

  bool operator==(const SideEdge&) const = default;
};

/// A set of caps and what bounds it.
struct WorldVolume {
  std::vector<CapFace> caps;
  std::vector<SideEdge> sides;
};

/// The edges of a frame's opaque polygons, each with a number: what caps have in common.
class EdgeTable {
 public:
  explicit EdgeTable(const SceneFrame& frame);

  /// The sides of a volume with these caps, in order of caps and corners. The frame has the same polygons as that which
  /// the table was made of.
  void sides(const SceneFrame& frame, std::span<const CapFace> caps, std::vector<SideEdge>& out);

  /// The opaque polygons that have the edge from corner k (into SceneFrame::corners) to the next, in either direction.
  [[nodiscard]] std::span<const std::uint32_t> polygons_at(std::size_t k) const {
    const std::uint32_t edge = half_edges_[k] >> 1;
    return std::span(polygons_).subspan(first_[edge], first_[edge + 1] - first_[edge]);
  }

 private:
  // For each corner the edge to the next: twice its number, plus 1 if it goes from the greater vertex to the lesser.
  std::vector<std::uint32_t> half_edges_;
  std::vector<std::uint32_t> first_;  // of each edge's polygons
  std::vector<std::uint32_t> polygons_;
  std::vector<std::int32_t> net_;  // 0 between calls
};

}  // namespace kage
