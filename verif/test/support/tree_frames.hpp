// SPDX-License-Identifier: Apache-2.0
//
// Properties of frames with polyhedra, as assertions.
#pragma once

#include "extremes/tree_frames.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

/// The counts of a frame's segments, which must all be right.
inline SegmentCount count_segments(const Picture& p, const FrameGeometry& g, const Config& config) {
  SegmentCount c = segment_count(p, g, config);
  INFO(c.wrong);
  CHECK(c.wrong.empty());
  return c;
}

/// Draws the same frame by spans and with each of kUnitCounts units: the same pixels. Gives the counts of the
/// segments, in that order.
inline std::array<SegmentCount, kUnitCounts.size()> same_either_way(const SceneFrame& f, const Config& config,
                                                                    int width, int height) {
  const auto counts = either_way_counts(f, config, width, height);
  for (const SegmentCount& c : counts) {
    INFO(c.wrong);
    CHECK(c.wrong.empty());
  }
  return counts;
}

}  // namespace kage::verif
