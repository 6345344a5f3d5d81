// SPDX-License-Identifier: Apache-2.0
//
// The part of a frame that goes to the compare tree: units, face numbers, and the segments of each line.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contract/derived.hpp"
#include "frontend/polyhedron.hpp"
#include "frontend/scan.hpp"
#include "kage/frontend.hpp"
#include "kage/token.hpp"

namespace kage {

class TreeLayout {
 public:
  TreeLayout(const FrameGeometry& geometry, const Config& config);

  /// Whether the frame has a tree at all.
  [[nodiscard]] bool any() const { return any_; }

  /// Drawn polygons before this one come by segments.
  [[nodiscard]] std::uint32_t first_span_polygon() const { return first_span_polygon_; }

  /// The FACE tokens of the frame.
  void faces(TokenWriter& writer) const;

  /// Lines that each of FrameGeometry::polyhedron_edges touches; none, if its polyhedron has no unit.
  [[nodiscard]] std::vector<LineRange> edge_lines() const;

  /// The SEG tokens of lines [y0, y1), lines[0] being y0's. `edges` are those that touch these lines, in the order of
  /// their numbers.
  void segments(int y0, int y1, std::span<const std::uint32_t> edges,
                std::vector<std::vector<std::uint32_t>>& lines) const;

  [[nodiscard]] PolyhedraReport report() const;

 private:
  [[nodiscard]] std::int32_t light(const ScreenPolygon& polygon, std::size_t channel) const;
  struct Member {
    std::uint32_t polyhedron;
    int first_face;  // in its unit's table
  };

  [[nodiscard]] int blank() const { return derived::blank_face(*config_); }

  const FrameGeometry* g_;
  const Config* config_;
  std::vector<int> unit_of_;  // as in PolyhedraReport
  PolyhedraReport::Stop stop_ = PolyhedraReport::Stop::none;
  std::vector<std::vector<Member>> members_;  // of each unit, in draw order
  std::uint32_t first_span_polygon_ = 0;
  bool any_ = false;
};

}  // namespace kage
