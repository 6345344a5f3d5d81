// SPDX-License-Identifier: Apache-2.0
#include "cost/line_clocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "kage/error.hpp"
#include "kage/explain.hpp"
#include "kage/stream.hpp"

namespace kage {

void LineClockCounter::add(int frame, std::span<const std::uint32_t> words) {
  const FrameHeader header = FrameHeader::read(words);
  if (header.width > config_.max_width)
    throw Error(fmt::format("frame {} is {} pixels wide; the configuration's MAX_WIDTH is {}", frame, header.width,
                            config_.max_width));
  counter_.start(header.width);
  TokenWalk walk(layout_, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next()) counter_.token(decode(config_, layout_, token));
  const std::vector<std::uint64_t>& lines = counter_.lines();
  const std::uint64_t all = std::accumulate(lines.begin(), lines.end(), std::uint64_t{0});
  ++sums_.frames;
  sums_.height = std::max(sums_.height, static_cast<int>(header.height));
  sums_.lines += lines.size();
  sums_.clocks += all;
  sums_.worst_frame = std::max(sums_.worst_frame, all);
  const auto worst = std::max_element(lines.begin(), lines.end());
  if (*worst > sums_.worst.clocks)
    sums_.worst = {.frame = frame, .line = static_cast<int>(worst - lines.begin()), .clocks = *worst};
  const std::size_t window = std::min(kLineWindow, lines.size());
  const double mean = static_cast<double>(worst_window(lines, window)) / static_cast<double>(window);
  if (mean > sums_.worst_window) {
    sums_.worst_window = mean;
    sums_.window = window;
  }
}

}  // namespace kage
