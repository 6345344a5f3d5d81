// SPDX-License-Identifier: Apache-2.0
//
// Scan conversion of outlines: which half-open ranges of each line are inside, and how often.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "frontend/edge_walker.hpp"

namespace kage {

/// A crossing of an edge with a line.
struct Crossing {
  int x;
  int winding;
};

/// Lines touched by an outline: [first, end), which may be empty.
struct LineRange {
  int first = 0;
  int end = 0;
};

/// Those whose centres an edge crosses.
constexpr LineRange lines_of(const ScreenVertex& a, const ScreenVertex& b) {
  return {first_centre(std::min(a.y, b.y)), first_centre(std::max(a.y, b.y))};
}

inline LineRange lines_of(std::span<const ScreenVertex> outline) {
  std::int32_t low = outline[0].y;
  std::int32_t high = low;
  for (const ScreenVertex& v : outline) {
    low = std::min(low, v.y);
    high = std::max(high, v.y);
  }
  return {first_centre(low), first_centre(high)};
}

/// Call emit(xl, xr, winding) for the ranges of [0, width) between sorted crossings where the winding number is not 0.
/// Ranges are as long as the winding number stays the same.
template <class Emit>
void fill_between(std::span<const Crossing> sorted, int width, Emit emit) {
  int winding = 0;
  int from = 0;
  for (std::size_t i = 0; i < sorted.size();) {
    const int x = std::clamp(sorted[i].x, 0, width);
    int change = 0;
    for (; i < sorted.size() && std::clamp(sorted[i].x, 0, width) == x; ++i) change += sorted[i].winding;
    if (change == 0) continue;
    if (winding != 0 && x > from) emit(from, x, winding);
    winding += change;
    from = x;
  }
  if (winding != 0 && width > from) emit(from, width, winding);
}

/// Insertion sort by x: outlines have two crossings on nearly every line.
inline void sort_crossings(std::vector<Crossing>& c) {
  for (std::size_t i = 1; i < c.size(); ++i)
    for (std::size_t j = i; j > 0 && c[j].x < c[j - 1].x; --j) std::swap(c[j], c[j - 1]);
}

/// Scans outlines; keeps its buffers.
class Scanner {
 public:
  /// emit(y, xl, xr, winding) for every range of the outline on the lines [y0, y1) and pixels [0, width), from top to
  /// bottom and left to right. Snapping may have bent the outline: the winding number then still adds up with that of
  /// its neighbours.
  template <class Emit>
  void scan(std::span<const ScreenVertex> outline, int y0, int y1, int width, Emit emit) {
    std::size_t count = 0;
    int y = y1;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const ScreenVertex& a = outline[i];
      const ScreenVertex& b = outline[i + 1 == outline.size() ? 0 : i + 1];
      const LineRange lines = lines_of(a, b);
      const int from = std::max(lines.first, y0);
      if (from >= std::min(lines.end, y1)) continue;
      if (count == edges_.size()) edges_.emplace_back();
      EdgeWalker& e = edges_[count++];
      e = EdgeWalker(a, b);
      e.start(from);
      y = std::min(y, from);
    }
    const std::span<EdgeWalker> edges = std::span(edges_).first(count);
    // Lines on which the same edges are there, until there are none.
    while (y < y1) {
      int end = y1;
      active_.clear();
      for (EdgeWalker& e : edges) {
        if (e.active(y)) {
          active_.push_back(&e);
          end = std::min(end, e.end());
        } else if (e.first() > y) {
          end = std::min(end, e.first());
        }
      }
      if (active_.empty())
        y = end;
      else if (active_.size() == 2)
        between_two(y, end, width, emit);
      else
        between_many(y, end, width, emit);
    }
  }

 private:
  // Two edges, one of which goes down and one up, as they do on nearly every line.
  template <class Emit>
  void between_two(int& y, int end, int width, Emit emit) {
    EdgeWalker& a = *active_[0];
    EdgeWalker& b = *active_[1];
    for (; y < end; ++y, a.next(), b.next()) {
      const int xa = std::clamp(a.x(), 0, width);
      const int xb = std::clamp(b.x(), 0, width);
      if (xa != xb) emit(y, std::min(xa, xb), std::max(xa, xb), xa < xb ? a.winding() : b.winding());
    }
  }

  template <class Emit>
  void between_many(int& y, int end, int width, Emit emit) {
    for (; y < end; ++y) {
      crossings_.clear();
      for (EdgeWalker* e : active_) {
        crossings_.push_back({e->x(), e->winding()});
        e->next();
      }
      sort_crossings(crossings_);
      fill_between(crossings_, width, [&](int xl, int xr, int winding) { emit(y, xl, xr, winding); });
    }
  }

  std::vector<EdgeWalker> edges_;  // those of the outline at hand, and room
  std::vector<EdgeWalker*> active_;
  std::vector<Crossing> crossings_;
};

}  // namespace kage
