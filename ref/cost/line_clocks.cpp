// SPDX-License-Identifier: Apache-2.0
#include "cost/line_clocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "kage/error.hpp"
#include "kage/stream.hpp"

namespace kage {
namespace {

// The run of neighbours whose sum exceeds `each` a line by most.
struct Neighbours {
  double excess = 0;
  std::size_t first = 0;
  std::size_t count = 0;
};

Neighbours worst_neighbours(std::span<const std::uint64_t> lines, double each) {
  Neighbours best;
  Neighbours here;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (here.count == 0 || here.excess <= 0) here = {0, i, 0};
    here.excess += static_cast<double>(lines[i]) - each;
    ++here.count;
    if (best.count == 0 || here.excess > best.excess) best = here;
  }
  return best;
}

}  // namespace

LineClocks::Need needed_line(std::span<const std::uint64_t> lines) {
  if (lines.empty()) return {};
  const auto need_of = [&](const Neighbours& run) {
    const auto sum = std::accumulate(lines.begin() + static_cast<std::ptrdiff_t>(run.first),
                                     lines.begin() + static_cast<std::ptrdiff_t>(run.first + run.count), 0.0);
    return (sum + kWayOutClocks) / static_cast<double>(run.count + 1);
  };
  // The run that exceeds T a line by most asks for more than T, or T is enough. Each step takes a run that asks for
  // more, and there are finitely many.
  double need = 0;
  Neighbours of;
  while (true) {
    const Neighbours run = worst_neighbours(lines, need);
    const double asked = need_of(run);
    if (of.count != 0 && !(asked > need)) break;
    need = asked;
    of = run;
  }
  return {.clocks = need, .frame = 0, .first = static_cast<int>(of.first), .count = static_cast<int>(of.count)};
}

void LineClockCounter::begin(int frame, const FrameHeader& header) {
  if (header.width > config_.max_width)
    throw Error(fmt::format("frame {} is {} pixels wide; the configuration's MAX_WIDTH is {}", frame, header.width,
                            config_.max_width));
  frame_ = frame;
  width_ = header.width;
  height_ = header.height;
  spans_.start(header);
  counter_.start(header.width);
}

void LineClockCounter::add(int frame, std::span<const std::uint32_t> words) {
  begin(frame, FrameHeader::read(words));
  TokenWalk walk(layout_, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next())
    this->token(decode(config_, layout_, token, walk.level()));
  end();
}

void LineClockCounter::end() {
  const std::vector<std::uint64_t>& lines = counter_.lines();
  const std::uint64_t all = std::accumulate(lines.begin(), lines.end(), std::uint64_t{0});
  ++sums_.frames;
  sums_.height = std::max(sums_.height, height_);
  sums_.lines += lines.size();
  sums_.clocks += all;
  sums_.worst_frame = std::max(sums_.worst_frame, all);
  const auto worst = std::max_element(lines.begin(), lines.end());
  if (worst == lines.end()) return;
  if (*worst > sums_.worst.clocks)
    sums_.worst = {.frame = frame_, .line = static_cast<int>(worst - lines.begin()), .clocks = *worst};
  const std::size_t window = std::min(kLineWindow, lines.size());
  const double mean = static_cast<double>(worst_window(lines, window)) / static_cast<double>(window);
  if (mean > sums_.worst_window) {
    sums_.worst_window = mean;
    sums_.window = window;
  }
  LineClocks::Need need = needed_line(lines);
  // The port sends a pixel a clock, so a display's line has its width at least.
  if (need.clocks < width_) need = {.clocks = static_cast<double>(width_), .frame = 0, .first = need.first, .count = 1};
  if (need.clocks > sums_.need.clocks) {
    sums_.need = need;
    sums_.need.frame = frame_;
  }
}

}  // namespace kage
