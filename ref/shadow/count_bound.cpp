// SPDX-License-Identifier: Apache-2.0
#include "shadow/count_bound.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "number/int128.hpp"

namespace kage {
namespace {

// Cells of this size, in powers of two, are not parted again.
constexpr int kLeastCell = 3;
// Visits of edges, as a multiple of their number: some 40 levels in two cells each, and as much again.
constexpr std::uint64_t kVisits = 200;
constexpr std::uint64_t kVisitsMore = 100'000;

int sign(Int128 x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

Int128 cross(const ChartPoint& d, const ChartPoint& e) {
  return static_cast<Int128>(d.x) * e.y - static_cast<Int128>(d.y) * e.x;
}

// Points of reference stand for ones a little to the right of them and, by much less, above, so that they lie on no
// edge. 1: left of the edge's line, -1: right of it.
int side(const ChartEdge& e, const ChartPoint& p) {
  const ChartPoint d{e.b.x - e.a.x, e.b.y - e.a.y};
  const int s = sign(cross(d, {p.x - e.a.x, p.y - e.a.y}));
  if (s != 0) return s;
  if (d.y != 0) return d.y > 0 ? -1 : 1;
  return d.x > 0 ? 1 : -1;
}

// Change of the count on the way from p to q on a level or upright line.
int crossing(const ChartEdge& e, const ChartPoint& p, const ChartPoint& q) {
  const bool apart = p.y == q.y ? (e.a.y <= p.y) != (e.b.y <= p.y) : (e.a.x <= p.x) != (e.b.x <= p.x);
  return apart ? (side(e, q) - side(e, p)) / 2 * e.w : 0;
}

struct Cell {
  ChartPoint low;
  int log = 0;    // its size is 2^log
  int count = 0;  // at its lower left corner
  int bound = 0;
  std::vector<std::uint32_t> edges;  // those that may touch it, its border included

  [[nodiscard]] ChartPoint corner(unsigned i) const {
    const std::int64_t size = std::int64_t{1} << log;
    return {low.x + ((i & 1U) != 0 ? size : 0), low.y + ((i & 2U) != 0 ? size : 0)};
  }
  // Between two cells with one bound, the smaller comes first: so it is soonest known where parting does not help.
  bool operator<(const Cell& o) const { return std::pair(bound, -log) < std::pair(o.bound, -o.log); }
};

class Bound {
 public:
  Bound(const std::vector<ChartEdge>& edges, int base, int target) : edges_(edges), target_(target) {
    Cell root;
    root.low = {-kChartHalf - 1, -kChartHalf - 1};
    root.log = 41;
    root.count = base;
    low_ = base;
    for (std::uint32_t i = 0; i < edges.size(); ++i)
      if (touches(edges[i], root)) root.edges.push_back(i);
    push(std::move(root));
  }

  CountRange find() {
    std::uint64_t visits = kVisits * edges_.size() + kVisitsMore;
    for (;;) {
      const Cell& top = cells_.front();
      const bool told = top.bound <= std::max(low_, target_) || (target_ >= 0 && low_ > target_);
      if (told || top.log <= kLeastCell || visits < top.edges.size()) return {low_, top.bound};
      std::pop_heap(cells_.begin(), cells_.end());
      const Cell cell = std::move(cells_.back());
      cells_.pop_back();
      visits -= cell.edges.size();
      part(cell);
    }
  }

 private:
  void push(Cell cell) {
    cell.bound = bound(cell);
    cells_.push_back(std::move(cell));
    std::push_heap(cells_.begin(), cells_.end());
  }

  static bool touches(const ChartEdge& e, const Cell& cell) {
    const ChartPoint low = cell.low;
    const ChartPoint high = cell.corner(3);
    if (std::max(e.a.x, e.b.x) < low.x || std::min(e.a.x, e.b.x) > high.x || std::max(e.a.y, e.b.y) < low.y ||
        std::min(e.a.y, e.b.y) > high.y)
      return false;
    const ChartPoint d{e.b.x - e.a.x, e.b.y - e.a.y};
    int left = 0;
    int right = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const ChartPoint p = cell.corner(i);
      const Int128 s = cross(d, {p.x - e.a.x, p.y - e.a.y});
      left += s > 0 ? 1 : 0;
      right += s < 0 ? 1 : 0;
    }
    return left < 4 && right < 4;
  }

  // The straight way from a point of reference to any point of the cell crosses an edge from its right to its left only
  // if the point of reference is right of the edge's line. The least bound over several points of reference holds.
  int bound(const Cell& cell) {
    std::array<ChartPoint, 4> at{};
    for (unsigned i = 0; i < 4; ++i) at[i] = cell.corner(i);
    std::array<int, 4> count{};
    std::array<int, 4> jumps{};
    count.fill(cell.count);
    for (const std::uint32_t i : cell.edges) {
      const ChartEdge& e = edges_[i];
      for (std::size_t k = 0; k < 4; ++k) jumps[k] += side(e, at[k]) < 0 ? e.w : 0;
      const int below = crossing(e, at[0], at[1]);
      count[1] += below;
      count[2] += crossing(e, at[0], at[2]);
      count[3] += below + crossing(e, at[1], at[3]);
    }
    int least = count[0] + jumps[0];
    for (std::size_t k = 0; k < 4; ++k) {
      low_ = std::max(low_, count[k]);
      least = std::min(least, count[k] + jumps[k]);
    }
    return least > std::max(low_, target_) ? std::min(least, round_vertex(cell, least)) : least;
  }

  // Where all edges of a cell meet in a vertex within it, the largest count of the sectors around that; else `other`.
  int round_vertex(const Cell& cell, int other) {
    if (cell.edges.size() < 2) return other;
    const ChartEdge& first = edges_[cell.edges[0]];
    const ChartEdge& second = edges_[cell.edges[1]];
    const ChartPoint v = first.a == second.a || first.a == second.b ? first.a : first.b;
    const ChartPoint high = cell.corner(3);
    if (v.x < cell.low.x || v.x > high.x || v.y < cell.low.y || v.y > high.y) return other;
    for (const std::uint32_t i : cell.edges)
      if (edges_[i].a != v && edges_[i].b != v) return other;
    // From the lower left corner round the vertex, counter-clockwise.
    struct Ray {
      ChartPoint d;
      int jump;
      int part;  // of the turn: its start, less than half, half, more, its end
    };
    std::vector<Ray> rays;
    const ChartPoint r{cell.low.x - v.x, cell.low.y - v.y};
    for (const std::uint32_t i : cell.edges) {
      const ChartEdge& e = edges_[i];
      const bool out = e.a == v;
      const ChartPoint& w = out ? e.b : e.a;
      Ray ray{{w.x - v.x, w.y - v.y}, out ? e.w : -e.w, 0};
      const int s = side({v, w, 1}, cell.low);
      const bool along = cross(r, ray.d) == 0;
      const bool ahead = static_cast<Int128>(r.x) * ray.d.x + static_cast<Int128>(r.y) * ray.d.y > 0;
      if (along)
        ray.part = !ahead ? 2 : s < 0 ? 0 : 4;
      else
        ray.part = s < 0 ? 1 : 3;
      rays.push_back(ray);
    }
    std::sort(rays.begin(), rays.end(),
              [](const Ray& p, const Ray& q) { return p.part != q.part ? p.part < q.part : cross(p.d, q.d) > 0; });
    int count = cell.count;
    int most = count;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      count += rays[i].jump;
      const bool more = i + 1 < rays.size() && rays[i + 1].part == rays[i].part && cross(rays[i].d, rays[i + 1].d) == 0;
      if (!more) most = std::max(most, count);
    }
    return most;
  }

  void part(const Cell& cell) {
    std::array<int, 4> count{};
    count.fill(cell.count);
    Cell child;
    child.low = cell.low;
    child.log = cell.log - 1;
    std::array<ChartPoint, 4> at{};
    for (unsigned i = 0; i < 4; ++i) at[i] = child.corner(i);
    for (const std::uint32_t i : cell.edges) {
      const ChartEdge& e = edges_[i];
      const int below = crossing(e, at[0], at[1]);
      count[1] += below;
      count[2] += crossing(e, at[0], at[2]);
      count[3] += below + crossing(e, at[1], at[3]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      Cell c;
      c.low = at[k];
      c.log = child.log;
      c.count = count[k];
      for (const std::uint32_t i : cell.edges)
        if (touches(edges_[i], c)) c.edges.push_back(i);
      push(std::move(c));
    }
  }

  const std::vector<ChartEdge>& edges_;
  int target_;
  int low_ = 0;
  std::vector<Cell> cells_;  // a heap
};

// Every edge once, with the sum of its weights.
void merge(std::vector<ChartEdge>& edges) {
  for (ChartEdge& e : edges)
    if (e.b < e.a) {
      std::swap(e.a, e.b);
      e.w = -e.w;
    }
  std::sort(edges.begin(), edges.end(),
            [](const ChartEdge& p, const ChartEdge& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size();) {
    ChartEdge e = edges[i];
    for (++i; i < edges.size() && edges[i].a == e.a && edges[i].b == e.b; ++i) e.w += edges[i].w;
    if (e.w == 0 || e.a == e.b) continue;
    if (e.w < 0) {
      std::swap(e.a, e.b);
      e.w = -e.w;
    }
    edges[kept++] = e;
  }
  edges.resize(kept);
}

}  // namespace

CountRange bound_count(std::vector<ChartEdge>& edges, int base, int target) {
  merge(edges);
  return Bound(edges, base, target).find();
}

}  // namespace kage
