// SPDX-License-Identifier: Apache-2.0
//
// Which polygons of a frame go as such, and at which place (docs/stream.md, "The polygon level").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "arena/arena.hpp"
#include "frontend/polygon_shape.hpp"
#include "frontend/uses.hpp"
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

  /// Drawn polygons before `first_span_polygon` go by segments. With `words` those without effect go no way; nullptr:
  /// all are to go.
  PolygonLayout(const FrameGeometry& geometry, const Config& config, std::uint32_t first_span_polygon,
                const SpanWords* words, Arena& arena);

  /// Whether places can count the frame's samples and volumes.
  static bool fits(const FrameGeometry& geometry);

  [[nodiscard]] Use opaque(std::size_t polygon) const { return use(Uses::drawn(polygon)); }
  [[nodiscard]] Use face(std::size_t volume_face) const { return use(uses_.face(volume_face)); }
  /// The n-th polygon of a fragment.
  [[nodiscard]] Use translucent(std::size_t fragment, std::uint32_t n) const {
    return use(uses_.translucent(fragment, n));
  }
  /// With linear light, in the pass of a light.
  [[nodiscard]] Use lit(std::size_t light, std::size_t polygon) const { return use(uses_.lit(light, polygon)); }
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
  [[nodiscard]] std::int64_t span_words(const Prices& prices, std::size_t use) const;

  void find_shapes(const Config& config, Arena& arena);
  void number_volumes();
  void choose(const Config& config);
  void choose_volumes(const Config& config);
  [[nodiscard]] PolygonWay choice(const Config& config, const Prices& prices, std::size_t use) const;
  void keep_active(const Config& config);
  void join_spans(const Config& config);
  void count();

  /// Call order(first, end) for the uses [first, end) of each layer, or volume, among which places count.
  template <class Each>
  void each_order(Each order) const;

  const FrameGeometry* g_;
  const SpanWords* words_;
  Uses uses_;
  std::uint32_t first_opaque_;
  std::vector<PolygonShape> shapes_;
  std::vector<PolygonWay> ways_;        // by number of the use
  std::vector<std::uint32_t> before_;   // likewise
  std::vector<std::uint32_t> made_of_;  // of each volume
  std::vector<std::uint32_t> number_;   // of each volume in its sample
  int active_ = 0;
  bool counts_ = false;  // RESOLVE tells a light's samples
};

}  // namespace kage
