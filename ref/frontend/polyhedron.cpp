// SPDX-License-Identifier: Apache-2.0
#include "frontend/polyhedron.hpp"

#include <algorithm>

#include "contract/derived.hpp"

namespace kage {

PolyhedronScanner::PolyhedronScanner(const FrameGeometry& geometry, const Config& config)
    : g_(&geometry),
      setup_(SpanSetup::depth(config)),
      most_depth_(derived::most_depth(config)),
      z_frac_(config.z_frac),
      max_dx_(derived::most_dx(config)) {
  const Field z = Layout(config).seg_z;
  least_z_ = z.is_signed ? -(std::int64_t{1} << (z.bits - 1)) : 0;
  most_z_ = least_z_ + (std::int64_t{1} << z.bits) - 1;
}

void PolyhedronScanner::begin(const Polyhedron& p, int y0, int y1) {
  representable_ = true;
  edges_.clear();
  active_.clear();
  entered_ = 0;
  first_ = y1;
  end_ = y0;
  first_polygon_ = p.first_polygon;
  if (faces_.size() < p.polygon_count) faces_.resize(p.polygon_count);
}

void PolyhedronScanner::load(const PolyhedronEdge& e, int y0, int y1) {
  if (e.from.y == e.to.y) return;
  Edge edge{EdgeWalker(e.from, e.to), e.along, e.against};
  const int from = std::max(edge.walker.first(), y0);
  const int to = std::min(edge.walker.end(), y1);
  if (from >= to) return;
  edge.walker.start(from);
  edge.first = from;
  edges_.push_back(edge);
  first_ = std::min(first_, from);
  end_ = std::max(end_, to);
  for (const std::uint32_t polygon : {e.along, e.against})
    if (polygon != PolyhedronEdge::kNoPolygon) faces_[polygon - first_polygon_] = {};
}

// The edges that cross line y, from left to right. From line to line few enter, leave or change places, so sorting by
// insertion looks at each about once.
void PolyhedronScanner::cross(int y) {
  std::erase_if(active_, [y](const Edge& e) { return e.walker.end() <= y; });
  for (Edge& e : active_) e.walker.next();
  for (; entered_ < edges_.size() && edges_[entered_].first == y; ++entered_) active_.push_back(edges_[entered_]);
  for (std::size_t i = 1; i < active_.size(); ++i) {
    if (active_[i].walker.x() >= active_[i - 1].walker.x()) continue;
    const Edge moved = active_[i];
    std::size_t j = i;
    for (; j > 0 && moved.walker.x() < active_[j - 1].walker.x(); --j) active_[j] = active_[j - 1];
    active_[j] = moved;
  }
}

void PolyhedronScanner::add(std::uint32_t polygon, int winding) {
  if (polygon == PolyhedronEdge::kNoPolygon) return;
  Face& f = faces_[polygon - first_polygon_];
  f.change += winding;
  if (f.touched) return;
  f.touched = true;
  touched_.push_back(polygon);
}

void PolyhedronScanner::close(std::uint32_t polygon, const Face& f, int x, int y) {
  if (f.winding == 0 || x <= f.from) return;
  const ScreenPlane& plane = g_->polygons[polygon].depth;
  const std::int64_t step = setup_.step(plane);
  int pieces = 0;
  setup_.each(plane, f.from, x, y, [&](int xl, int xr, SpanSetup::Ramp ramp) {
    ++pieces;
    if (xr - xl > 1 && ramp.step != step) representable_ = false;
    parts_.push_back({xl, xr, polygon, ramp});
  });
  if (pieces > 1) representable_ = false;
}

// Outlines are closed, and crossings beyond the last pixel count at it: every face is closed when the line ends.
void PolyhedronScanner::fill(int y) {
  runs_.clear();
  parts_.clear();
  const auto at = [&](std::size_t i) { return std::clamp(active_[i].walker.x(), 0, g_->width); };
  for (std::size_t i = 0; i < active_.size();) {
    const int x = at(i);
    for (; i < active_.size() && at(i) == x; ++i) {
      add(active_[i].along, active_[i].walker.winding());
      add(active_[i].against, -active_[i].walker.winding());
    }
    for (const std::uint32_t polygon : touched_) {
      Face& f = faces_[polygon - first_polygon_];
      f.touched = false;
      if (f.change == 0) continue;
      close(polygon, f, x, y);
      f.winding += f.change;
      f.change = 0;
      f.from = x;
    }
    touched_.clear();
  }
  settle();
}

std::int64_t PolyhedronScanner::depth(const Part& p, int x) const {
  const std::int64_t z = (p.ramp.start + (x - p.xl) * p.ramp.step) >> z_frac_;
  return std::clamp(z, std::int64_t{1}, most_depth_);
}

// Where parts overlap, which only the snap can cause, each pixel goes to the part with the least (Z, polygon), as with
// spans.
void PolyhedronScanner::settle() {
  std::sort(parts_.begin(), parts_.end(),
            [](const Part& a, const Part& b) { return a.xl != b.xl ? a.xl < b.xl : a.polygon < b.polygon; });
  const auto put = [&](const Part& p, int xl, int xr) {
    const std::int64_t z = p.ramp.start + (xl - p.xl) * p.ramp.step;
    // A long run is split: the last segment starts this far on. In between, sums lie in between.
    const std::int64_t last = z + static_cast<std::int64_t>((xr - xl - 1) / max_dx_) * max_dx_ * p.ramp.step;
    if (z < least_z_ || z > most_z_ || last < least_z_ || last > most_z_) representable_ = false;
    runs_.push_back({xl, xr, p.polygon, z});
  };
  for (std::size_t i = 0; i < parts_.size();) {
    // A group of parts that hang together by overlaps.
    std::size_t end = i + 1;
    int right = parts_[i].xr;
    while (end < parts_.size() && parts_[end].xl < right) right = std::max(right, parts_[end++].xr);
    if (end == i + 1) {
      put(parts_[i], parts_[i].xl, parts_[i].xr);
    } else {
      const Part* last = nullptr;
      int from = 0;
      for (int x = parts_[i].xl; x <= right; ++x) {
        const Part* best = nullptr;
        for (std::size_t k = i; k < end && x < right; ++k) {
          const Part& p = parts_[k];
          if (x < p.xl || x >= p.xr) continue;
          if (best == nullptr || depth(p, x) < depth(*best, x) ||
              (depth(p, x) == depth(*best, x) && p.polygon < best->polygon))
            best = &p;
        }
        if (best == last) continue;
        if (last != nullptr) put(*last, from, x);
        last = best;
        from = x;
      }
    }
    i = end;
  }
}

}  // namespace kage
