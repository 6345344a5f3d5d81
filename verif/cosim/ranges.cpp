// SPDX-License-Identifier: Apache-2.0
#include "cosim/ranges.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace kage::cosim {

std::vector<FrameRange> split(const FrameSteps& steps, int frames, int ranges) {
  const int count = steps.below(frames);
  const int parts = std::clamp(ranges, 1, std::max(count, 1));
  std::vector<FrameRange> all;
  for (int i = 0; i < parts; ++i) {
    // The first ranges have one more, where it does not come out even.
    const auto at = [&](int part) { return part * (count / parts) + std::min(part, count % parts); };
    all.push_back({{steps.first + at(i) * steps.step, steps.step},
                   i + 1 == parts ? frames : steps.first + at(i + 1) * steps.step,
                   i == 0 ? 0 : 1});
  }
  return all;
}

Report join(std::vector<Report> ranges) {
  Report all = std::move(ranges.front());
  for (std::size_t i = 1; i < ranges.size() && all.same; ++i) {
    Report& r = ranges[i];
    all.same = r.same;
    all.broken = all.broken || r.broken;
    all.frames += r.frames;
    all.width = std::max(all.width, r.width);
    all.height = std::max(all.height, r.height);
    all.pixels_compared += r.pixels_compared;
    all.spans += r.spans;
    all.span_pixels += r.span_pixels;
    all.segments += r.segments;
    all.cycles += r.cycles;
    all.stalls.starved += r.stalls.starved;
    all.stalls.blocked += r.stalls.blocked;
    all.expected_seconds += r.expected_seconds;
    all.actual_seconds += r.actual_seconds;
    all.frame_seconds.insert(all.frame_seconds.end(), r.frame_seconds.begin(), r.frame_seconds.end());
    all.pictures.insert(all.pictures.end(), std::make_move_iterator(r.pictures.begin()),
                        std::make_move_iterator(r.pictures.end()));
    all.taken.insert(all.taken.end(), r.taken.begin(), r.taken.end());
    for (FrameResult& f : r.each) {
      const bool different = r.first_difference && f.frame == r.first_difference->frame;
      if (all.each.size() < kFrameResults || different) all.each.push_back(std::move(f));
    }
    all.first_difference = std::move(r.first_difference);
    all.difference = std::move(r.difference);
  }
  return all;
}

}  // namespace kage::cosim
