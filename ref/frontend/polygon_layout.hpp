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

class Prices;

/// Layout of a frame at the polygon level: which way each polygon goes in each of its roles.
class PolygonLayout {
 public:
  /// A polygon in one of its roles: drawn, face of a volume, of a translucent fragment, or drawn again with a light.
  struct Use {
    PolygonWay way;
    std::uint32_t before;  ///< how many that go as such stand before it: in its layer, or of its volume

    [[nodiscard]] bool made() const { return way == PolygonWay::polygon; }
  };

  /// Drawn polygons before `first_span_polygon` go by segments.
  PolygonLayout(const FrameGeometry& geometry, const Config& config, std::uint32_t first_span_polygon, Arena& arena);

  /// Whether places can count the frame's samples and volumes.
  static bool fits(const FrameGeometry& geometry);

  [[nodiscard]] Use opaque(std::size_t polygon) const { return use(polygon); }
  [[nodiscard]] Use face(std::size_t volume_face) const { return use(first_face_ + volume_face); }
  /// The n-th polygon of a fragment.
  [[nodiscard]] Use translucent(std::size_t fragment, std::uint32_t n) const {
    return use(first_of_fragment_[fragment] + n);
  }
  /// With linear light, in the pass of a light.
  [[nodiscard]] Use lit(std::size_t light, std::size_t polygon) const { return use(first_lit(light) + polygon); }
  [[nodiscard]] const PolygonShape& shape(std::size_t polygon) const { return shapes_[polygon]; }

  /// The place of what stands between two faces of a volume: `before` of it go as such before it.
  [[nodiscard]] Place place(std::uint32_t volume, std::uint32_t before) const;
  /// The same of what brings a light.
  [[nodiscard]] Place light_place(std::size_t light, std::uint32_t before) const;
  /// How many faces of a volume go as such.
  [[nodiscard]] std::uint32_t made_of(std::uint32_t volume) const { return made_of_[volume]; }

  /// Add the polygons, and the spans of those that go as such: the spans of others are for whoever makes them to count.
  void add_to(PolygonReport& report) const;

 private:
  [[nodiscard]] Use use(std::size_t i) const { return {ways_[i], before_[i]}; }
  [[nodiscard]] std::size_t first_lit(std::size_t light) const { return first_lit_ + light * g_->drawn; }
  [[nodiscard]] Kind span_of(std::size_t use) const;
  [[nodiscard]] std::uint32_t polygon_of(std::size_t use) const;

  void find_shapes(const Config& config, Arena& arena);
  void number_uses(const Config& config);
  void choose(const Config& config);
  [[nodiscard]] PolygonWay choice(const Config& config, const Prices& prices, std::size_t use) const;
  void keep_active(const Config& config);
  void join_spans(const Config& config);
  void count();

  /// Call order(first, end) for the uses [first, end) of each layer, or volume, among which places count.
  template <class Each>
  void each_order(Each order) const;

  const FrameGeometry* g_;
  std::uint32_t first_opaque_;
  std::vector<PolygonShape> shapes_;
  // By number of the use: first drawn polygons, then faces of volumes, then polygons of fragments, then drawn polygons
  // once more for each light.
  std::vector<PolygonWay> ways_;
  std::vector<std::uint32_t> before_;
  std::size_t first_face_ = 0;
  std::size_t first_translucent_ = 0;
  std::size_t first_lit_ = 0;
  std::vector<std::size_t> first_of_fragment_;
  std::vector<std::uint32_t> fragment_of_;  // from first_translucent_ on
  std::vector<std::uint32_t> made_of_;      // of each volume
  std::vector<std::uint32_t> number_;       // of each volume in its sample
  int active_ = 0;
  bool counts_ = false;  // RESOLVE tells a light's samples
};

}  // namespace kage
