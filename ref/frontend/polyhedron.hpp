// SPDX-License-Identifier: Apache-2.0
//
// Scan conversion of convex polyhedra to runs of one face [Ohno 1985: from vertex interval to vertex interval, links
// sorted by x, by increments from line to line]. Each edge is walked once for both of its faces. Walking, half-open
// rule and ramps are those of spans, so a polyhedron gives the same bits either way.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/edge_walker.hpp"
#include "frontend/span_setup.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Pixels [xl, xr) of a line that show `polygon`; z at xl, half an LSB included.
struct Run {
  int xl = 0;
  int xr = 0;
  std::uint32_t polygon = 0;
  std::int64_t z = 0;
};

/// Scans polyhedra; keeps its buffers.
class PolyhedronScanner {
 public:
  PolyhedronScanner(const FrameGeometry& geometry, const Config& config);

  /// emit(y, runs) for each of the lines [y0, y1) that the polyhedron touches, from top to bottom; runs go from left to
  /// right and do not overlap.
  template <class Emit>
  void scan(const Polyhedron& p, int y0, int y1, Emit emit) {
    begin(p, y0, y1);
    for (std::uint32_t i = 0; i < p.edge_count; ++i) load(g_->polyhedron_edges[p.first_edge + i], y0, y1);
    lines(emit);
  }

  /// The same, where it is known which edges touch those lines: `touching` are all of the polyhedron's that do, into
  /// FrameGeometry::polyhedron_edges. Others are not looked at.
  template <class Emit>
  void scan(const Polyhedron& p, std::span<const std::uint32_t> touching, int y0, int y1, Emit emit) {
    begin(p, y0, y1);
    for (const std::uint32_t i : touching) load(g_->polyhedron_edges[i], y0, y1);
    lines(emit);
  }

  /// False if a run's depth does not go on by its face's own step from pixel to pixel, or does not fit a segment: then
  /// the last scanned polyhedron cannot be segments.
  [[nodiscard]] bool representable() const { return representable_; }

 private:
  struct Edge {
    EdgeWalker walker;
    std::uint32_t along;
    std::uint32_t against;
    int first = 0;  // line on which it enters
  };
  struct Face {
    int winding = 0;
    int change = 0;  // at the crossing at hand
    int from = 0;    // where its span began
    bool touched = false;
  };
  // A span of one face, before overlaps are settled.
  struct Part {
    int xl;
    int xr;
    std::uint32_t polygon;
    SpanSetup::Ramp ramp;
  };

  template <class Emit>
  void lines(Emit emit) {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.first < b.first; });
    for (int y = first_; y < end_; ++y) {
      cross(y);
      fill(y);
      if (!runs_.empty()) emit(y, std::span<const Run>(runs_));
    }
  }

  void begin(const Polyhedron& p, int y0, int y1);
  void load(const PolyhedronEdge& e, int y0, int y1);
  void cross(int y);
  void fill(int y);
  void add(std::uint32_t polygon, int winding);
  void close(std::uint32_t polygon, const Face& face, int x, int y);
  void settle();
  [[nodiscard]] std::int64_t depth(const Part& p, int x) const;

  const FrameGeometry* g_;
  SpanSetup setup_;
  std::int64_t most_depth_;
  int z_frac_;
  int max_dx_;
  std::int64_t least_z_;  // of a segment's start
  std::int64_t most_z_;
  std::vector<Edge> edges_;  // by the line on which they enter
  std::size_t entered_ = 0;
  std::vector<Edge> active_;  // from left to right
  std::uint32_t first_polygon_ = 0;
  std::vector<Face> faces_;             // of the polyhedron, by polygon; those that no edge has loaded are stale
  std::vector<std::uint32_t> touched_;  // polygons at the crossing at hand
  std::vector<Part> parts_;
  std::vector<Run> runs_;
  int first_ = 0;
  int end_ = 0;
  bool representable_ = true;
};

}  // namespace kage
