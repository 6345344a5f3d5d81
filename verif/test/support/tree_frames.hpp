// SPDX-License-Identifier: Apache-2.0
//
// What holds of frames with polyhedra, as assertions.
#pragma once

#include "extremes/tree_frames.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

/// What a frame's segments are. All that has to be of them is.
inline SegmentCount count_segments(const Picture& p, const FrameGeometry& g, const Config& config) {
  SegmentCount c = segment_count(p, g, config);
  INFO(c.wrong);
  CHECK(c.wrong.empty());
  return c;
}

/// The same frame by spans and with each of kUnitCounts units: the same pixels. What the segments were, in that order.
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
