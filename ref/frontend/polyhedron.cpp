// SPDX-License-Identifier: Apache-2.0
#include "frontend/polyhedron.hpp"

#include <algorithm>

namespace kage {

PolyhedronScanner::PolyhedronScanner(const FrameGeometry& geometry, const Config& config)
    : g_(&geometry),
      setup_(config.z_frac, config.z_bits + config.z_frac + 2),
      z_bits_(config.z_bits),
      z_frac_(config.z_frac) {
  const int bits = config.z_bits + config.z_frac + 2;
  least_z_ = config.classic != 0 ? 0 : -(std::int64_t{1} << (bits - 1));
  most_z_ = config.classic != 0 ? 32767 : (std::int64_t{1} << (bits - 1)) - 1;
}

void PolyhedronScanner::load(const Polyhedron& p, int y0, int y1) {
  representable_ = true;
  edges_.clear();
  first_ = y1;
  end_ = y0;
  for (const PolyhedronEdge& e : std::span(g_->polyhedron_edges).subspan(p.first_edge, p.edge_count)) {
    if (e.from.y == e.to.y) continue;
    Edge edge{EdgeWalker(e.from, e.to), e.along, e.against};
    const int from = std::max(edge.walker.first(), y0);
    const int to = std::min(edge.walker.end(), y1);
    if (from >= to) continue;
    edge.walker.start(from);
    edges_.push_back(edge);
    first_ = std::min(first_, from);
    end_ = std::max(end_, to);
  }
}

void PolyhedronScanner::cross(int y) {
  crossings_.clear();
  for (Edge& e : edges_) {
    if (!e.walker.active(y)) continue;
    crossings_.push_back({std::clamp(e.walker.x(), 0, g_->width), e.walker.winding(), e.along, e.against});
    e.walker.next();
  }
  // Nearly sorted already: coherence from line to line is in the order of the edges.
  for (std::size_t i = 1; i < crossings_.size(); ++i)
    for (std::size_t j = i; j > 0 && crossings_[j].x < crossings_[j - 1].x; --j)
      std::swap(crossings_[j], crossings_[j - 1]);
}

void PolyhedronScanner::add(std::uint32_t polygon, int winding) {
  if (polygon == PolyhedronEdge::kNoPolygon) return;
  for (Open& o : open_)
    if (o.polygon == polygon) {
      o.change += winding;
      return;
    }
  open_.push_back({polygon, 0, winding, 0});
}

void PolyhedronScanner::close(Open& o, int x, int y) {
  if (o.winding == 0 || x <= o.from) return;
  const ScreenPlane& plane = g_->polygons[o.polygon].depth;
  const std::int64_t step = setup_.step(plane);
  int pieces = 0;
  setup_.each(plane, o.from, x, y, [&](int xl, int xr, SpanSetup::Ramp ramp) {
    ++pieces;
    if (xr - xl > 1 && ramp.step != step) representable_ = false;
    parts_.push_back({xl, xr, o.polygon, ramp});
  });
  if (pieces > 1) representable_ = false;
}

void PolyhedronScanner::fill(int y) {
  runs_.clear();
  parts_.clear();
  open_.clear();
  for (std::size_t i = 0; i < crossings_.size();) {
    const int x = crossings_[i].x;
    for (; i < crossings_.size() && crossings_[i].x == x; ++i) {
      add(crossings_[i].along, crossings_[i].winding);
      add(crossings_[i].against, -crossings_[i].winding);
    }
    for (Open& o : open_) {
      if (o.change == 0) continue;
      close(o, x, y);
      o.winding += o.change;
      o.change = 0;
      o.from = x;
    }
    std::erase_if(open_, [](const Open& o) { return o.winding == 0; });
  }
  for (Open& o : open_) close(o, g_->width, y);
  settle();
}

std::int64_t PolyhedronScanner::depth(const Part& p, int x) const {
  const std::int64_t z = (p.ramp.start + (x - p.xl) * p.ramp.step) >> z_frac_;
  return std::clamp(z, std::int64_t{1}, (std::int64_t{1} << z_bits_) - 2);
}

// Of overlapping parts, which only the snap can make, each pixel goes to the least (Z, polygon), as spans would have
// it.
void PolyhedronScanner::settle() {
  std::sort(parts_.begin(), parts_.end(),
            [](const Part& a, const Part& b) { return a.xl != b.xl ? a.xl < b.xl : a.polygon < b.polygon; });
  const auto put = [&](const Part& p, int xl, int xr) {
    const std::int64_t z = p.ramp.start + (xl - p.xl) * p.ramp.step;
    if (z < least_z_ || z > most_z_) representable_ = false;
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
