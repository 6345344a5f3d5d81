// SPDX-License-Identifier: Apache-2.0
//
// Which of many things touch a band of lines, for all bands from the top: linear in what there is to say.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "frontend/scan.hpp"

namespace kage {

/// Lines of a band, what is scanned in one piece.
inline constexpr int kBandLines = 16;

/// The items that touch each band of lines, in the order of their numbers, band after band from the top. Each item is
/// held once, however many bands it touches.
class Sweep {
 public:
  Sweep(int bands, int height, std::span<const LineRange> ranges)
      : start_(static_cast<std::size_t>(bands) + 1, 0), end_band_(ranges.size(), 0) {
    const auto each = [&](auto what) {
      for (std::size_t i = 0; i < ranges.size(); ++i) {
        const int first = std::max(ranges[i].first, 0);
        const int end = std::min(ranges[i].end, height);
        if (first < end) what(i, static_cast<std::size_t>(first / kBandLines), (end - 1) / kBandLines + 1);
      }
    };
    each([this](std::size_t, std::size_t band, int) { ++start_[band + 1]; });
    for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
    items_.resize(start_.back());
    std::vector<std::size_t> at(start_.begin(), start_.end() - 1);
    each([&](std::size_t i, std::size_t band, int end) {
      items_[at[band]++] = static_cast<std::uint32_t>(i);
      end_band_[i] = end;
    });
  }

  /// Numbers of the items that touch the next band.
  const std::vector<std::uint32_t>& next() {
    std::erase_if(active_, [this](std::uint32_t i) { return end_band_[i] <= band_; });
    const auto b = static_cast<std::size_t>(band_++);
    const auto old = static_cast<std::ptrdiff_t>(active_.size());
    active_.insert(active_.end(), items_.begin() + static_cast<std::ptrdiff_t>(start_[b]),
                   items_.begin() + static_cast<std::ptrdiff_t>(start_[b + 1]));
    std::inplace_merge(active_.begin(), active_.begin() + old, active_.end());
    return active_;
  }

 private:
  std::vector<std::size_t> start_;    // in items_, by the band in which items begin
  std::vector<std::uint32_t> items_;  // by first band, then by number
  std::vector<int> end_band_;
  std::vector<std::uint32_t> active_;
  int band_ = 0;
};

}  // namespace kage
