// SPDX-License-Identifier: Apache-2.0
//
// A frame on its way to bands of lines.
#pragma once

#include <tbb/blocked_range.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "arena/arena.hpp"
#include "frontend/polygon_layout.hpp"
#include "frontend/sweep.hpp"
#include "frontend/tree_layout.hpp"
#include "frontend/uses.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// Data of a frame that all bands share.
struct FramePlan {
  const FrameGeometry* geometry;
  const Config* config;
  TreeLayout tree;
  Uses uses;
  std::vector<std::uint32_t> volume_of_face;
  std::vector<std::uint32_t> volume_of_edge;
  Sweep polygons;
  Sweep faces;
  Sweep edges;
  Sweep tree_edges;
  Sweep fragments;
  bool all_spans;                       // those without effect too
  std::optional<PolygonLayout> layout;  // at the polygon level
};

/// Numbers of the polygons, faces, edges and fragments that touch a band.
struct BandWork {
  std::vector<std::uint32_t> polygons;
  std::vector<std::uint32_t> faces;
  std::vector<std::uint32_t> edges;
  std::vector<std::uint32_t> tree_edges;  // of the lines ahead: one further down than the band's
  std::vector<std::uint32_t> fragments;
};

/// Prepares a frame. Throws Error if the configuration cannot hold it.
FramePlan plan_frame(const FrameGeometry& geometry, const Config& config, bool all_spans);

/// Makes bands on several threads, a few at a time, and hands them on in order: memory holds no more than those.
class Bands {
 public:
  Bands(int height, int threads)
      : count_((height + kBandLines - 1) / kBandLines),
        wave_(threads == 1 ? 1 : std::clamp(count_, 1, 8)),
        arena_(threads) {}

  Arena& arena() { return arena_; }
  /// How many are made side by side.
  [[nodiscard]] std::size_t wave() const { return static_cast<std::size_t>(wave_); }

  /// Call take(band) for each, from the top. `bands` has wave() of them: each has work(), to be filled in, and
  /// make(number).
  template <class Band, class Take>
  void make(FramePlan& frame, std::deque<Band>& bands, Take take) {
    for (int first = 0; first < count_; first += wave_) {
      const int end = std::min(first + wave_, count_);
      const auto of = [&](int b) -> Band& { return bands[static_cast<std::size_t>(b - first)]; };
      for (int b = first; b < end; ++b) {
        BandWork& work = of(b).work();
        work.polygons = frame.polygons.next();
        work.faces = frame.faces.next();
        work.edges = frame.edges.next();
        work.tree_edges = frame.tree_edges.next();
        work.fragments = frame.fragments.next();
      }
      if (wave_ == 1)
        of(first).make(first);
      else
        arena_.for_each(tbb::blocked_range<int>(first, end), [&](const tbb::blocked_range<int>& some) {
          for (int b = some.begin(); b < some.end(); ++b) of(b).make(b);
        });
      for (int b = first; b < end; ++b) take(of(b));
    }
  }

 private:
  int count_;
  int wave_;
  Arena arena_;
};

}  // namespace kage
