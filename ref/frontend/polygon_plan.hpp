// SPDX-License-Identifier: Apache-2.0
//
// Which polygons of a frame go as such, and at which place (docs/stream.md, "The polygon level").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "arena/arena.hpp"
#include "frontend/polygon_shape.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"
#include "polygon/place.hpp"

namespace kage {

/// A polygon that has no span goes no way.
inline constexpr auto kUnseen = static_cast<PolygonWay>(kPolygonWays);
/// Polygons of so many lines are tall (PolygonReport).
inline constexpr int kTallLines = 3;

/// Of a frame at the polygon level.
class PolygonPlan {
 public:
  /// A polygon in one of its roles: drawn, face of a volume, or of a translucent fragment.
  struct Use {
    PolygonWay way;
    std::uint32_t before;  ///< how many that go as such stand before it: in its layer, or of its volume

    [[nodiscard]] bool made() const { return way == PolygonWay::polygon; }
  };

  /// Drawn polygons before `first_span_polygon` go by segments.
  PolygonPlan(const FrameGeometry& geometry, const Config& config, std::uint32_t first_span_polygon, Arena& arena);

  /// Whether places can count the frame's samples and volumes.
  static bool fits(const FrameGeometry& geometry);

  [[nodiscard]] Use opaque(std::size_t polygon) const { return opaque_.use(polygon); }
  [[nodiscard]] Use face(std::size_t volume_face) const { return faces_.use(volume_face); }
  /// The n-th polygon of a fragment.
  [[nodiscard]] Use translucent(std::size_t fragment, std::uint32_t n) const {
    return translucent_.use(first_translucent_[fragment] + n);
  }
  [[nodiscard]] const PolygonShape& shape(std::size_t polygon) const { return shapes_[polygon]; }

  /// The place of what stands between two faces of a volume: `before` of it go as such before it.
  [[nodiscard]] Place place(std::uint32_t volume, std::uint32_t before) const;
  /// How many faces of a volume go as such.
  [[nodiscard]] std::uint32_t made_of(std::uint32_t volume) const { return made_of_[volume]; }

  /// Add the polygons, and the spans of those that go as such: the spans of others are for whoever makes them to count.
  void add_to(PolygonReport& report) const;

 private:
  struct Uses {
    std::vector<PolygonWay> way;
    std::vector<std::uint32_t> before;

    [[nodiscard]] Use use(std::size_t i) const { return {way[i], before[i]}; }
    void resize(std::size_t n) {
      way.resize(n);
      before.resize(n);
    }
  };

  void find_shapes(const Config& config, Arena& arena);
  void choose(const Config& config);
  void keep_active(const Config& config);
  void count();

  /// Call use(way, shape) for all uses of a plan, in the order of their places.
  template <class Plan, class Each>
  static void each(Plan& plan, Each use);

  const FrameGeometry* g_;
  std::uint32_t first_opaque_;
  std::vector<PolygonShape> shapes_;
  Uses opaque_;
  Uses faces_;
  Uses translucent_;
  std::vector<std::size_t> first_translucent_;  // of each fragment, into translucent_
  std::vector<std::uint32_t> made_of_;          // of each volume
  std::vector<std::uint32_t> number_;           // of each volume in its sample
  int active_ = 0;
};

}  // namespace kage
