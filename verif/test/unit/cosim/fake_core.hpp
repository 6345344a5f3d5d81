// SPDX-License-Identifier: Apache-2.0
//
// A core of words that are no stream, which may lie, and frames for it.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cosim/core.hpp"
#include "cosim/run.hpp"

namespace kage::cosim {

using Line = std::vector<std::uint8_t>;

/// Makes a line of every word but the first two, which are the frame's number and size; the pattern depends on number,
/// line and x. Lines and a frame's end may be changed on their way out.
class FakeCore : public Core {
 public:
  std::function<void(std::uint32_t frame, int y, Line&)> spoil_line;
  std::function<void(std::uint32_t frame, FrameEnd&)> spoil_end;

  [[nodiscard]] int channels() const override { return 3; }

  void feed(std::span<const std::uint32_t> words, const LineSink& sink) override {
    for (const std::uint32_t word : words) {
      if (seen_++ == 0) frame_ = word;
      if (seen_ == 2) size_ = word;
      if (seen_ <= 2) continue;
      Line line(std::size_t{size_ & 0xFFFF} * 3);
      const auto y = static_cast<int>(seen_ - 3);
      for (std::size_t i = 0; i < line.size(); ++i)
        line[i] = static_cast<std::uint8_t>(i + frame_ + 7 * static_cast<std::size_t>(y));
      if (spoil_line) spoil_line(frame_, y, line);
      if (!line.empty()) sink(y, line);
    }
  }

  FrameEnd finish(const LineSink&) override {
    FrameEnd end;
    end.status.width = static_cast<int>(size_ & 0xFFFF);
    end.status.height = static_cast<int>(size_ >> 16);
    end.cycles = 100;
    if (spoil_end) spoil_end(frame_, end);
    seen_ = 0;
    return end;
  }

 private:
  std::uint32_t frame_ = 0;
  std::uint32_t size_ = 0;
  std::size_t seen_ = 0;
};

/// Frames of `width` x `height`, so many lines a piece.
inline Feed feed_of(std::uint32_t width, std::uint32_t height, std::uint32_t lines_a_piece) {
  return [=](int index, const WordSink& sink) {
    std::vector<std::uint32_t> words{static_cast<std::uint32_t>(index), width | height << 16};
    for (std::uint32_t y = 0; y < height; ++y) {
      words.push_back(y);
      if ((y + 1) % lines_a_piece != 0) continue;
      sink(words);
      words.clear();
    }
    if (!words.empty()) sink(words);
    TokenCounts counts;
    counts.spans = 10;
    return counts;
  };
}

}  // namespace kage::cosim
