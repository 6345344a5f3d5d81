// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cosim/core.hpp"

namespace kage::cosim {

/// The pixels of a frame, as they come, as lines.
class VideoLines {
 public:
  /// A frame begins whose size is not known yet: no pixel is taken.
  void start() { *this = {}; }

  /// The frame has this size, and its pixels so many bytes each.
  void expect(std::uint32_t width, std::uint32_t height, std::size_t channels) {
    channels_ = channels;
    line_bytes_ = width * channels;
    left_ = std::uint64_t{width} * height;
  }

  /// Pixels to come.
  [[nodiscard]] std::uint64_t left() const { return left_; }

  /// So many pixels of those to come, or as many as are to come. Whole lines go to the sink, the beginning of another
  /// stays.
  void take(const std::uint8_t* pixels, std::uint64_t count, const LineSink& sink) {
    count = std::min(count, left_);
    left_ -= count;
    std::span<const std::uint8_t> bytes(pixels, static_cast<std::size_t>(count) * channels_);
    while (!bytes.empty()) {
      const auto part = bytes.first(std::min(bytes.size(), line_bytes_ - line_.size()));
      bytes = bytes.subspan(part.size());
      if (part.size() == line_bytes_) {
        sink(y_++, part);
        continue;
      }
      line_.insert(line_.end(), part.begin(), part.end());
      if (line_.size() < line_bytes_) continue;
      sink(y_++, line_);
      line_.clear();
    }
  }

  /// No more pixels come: a line that has begun goes to the sink as it is.
  void end(const LineSink& sink) {
    if (!line_.empty()) sink(y_, line_);
  }

 private:
  std::size_t channels_ = 1;
  std::size_t line_bytes_ = 0;
  std::uint64_t left_ = 0;
  int y_ = 0;                       // of the line to come
  std::vector<std::uint8_t> line_;  // the part of it that is here
};

}  // namespace kage::cosim
