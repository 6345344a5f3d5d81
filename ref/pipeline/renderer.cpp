// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "kage/error.hpp"
#include "kage/pipeline.hpp"
#include "pipeline/stopwatch.hpp"

namespace kage {

Renderer::Renderer(FrameSource& source, bool through_words) : source_(&source), through_words_(through_words) {}

FrameStatus Renderer::frame(int index, const SizeSink& start, const LineSink& sink) {
  counts_.reset();
  if (through_words_) return through_words(index, start, sink);
  FrameStatus status;
  double seconds = 0;
  bool drawn = false;
  {
    Stopwatch watch(seconds);
    drawn = source_->draw(
        index,
        [&](int width, int height) {
          status.width = width;
          status.height = height;
          start(width, height);
        },
        watch.outside(sink));
  }
  if (!drawn) return through_words(index, start, sink);
  seconds_ += seconds;
  return status;
}

FrameStatus Renderer::through_words(int index, const SizeSink& start, const LineSink& sink) {
  if (!core_) core_.emplace(source_->config());
  std::vector<std::uint32_t> head;  // of the header: the picture's size
  const LineSink lines = [&](int y, std::span<const std::uint8_t> line) {
    if (y == 0) {
      const FrameHeader header = FrameHeader::read(head);
      start(header.width, header.height);
    }
    sink(y, line);
  };
  try {
    counts_ = source_->frame(index, [&](std::span<const std::uint32_t> piece) {
      head.insert(head.end(), piece.begin(),
                  piece.begin() + static_cast<std::ptrdiff_t>(std::min(piece.size(), kHeaderWords - head.size())));
      Stopwatch watch(seconds_);
      core_->feed(piece, watch.outside(lines));
    });
    Stopwatch watch(seconds_);
    return core_->finish(watch.outside(lines));
  } catch (...) {
    core_.reset();  // what came of the frame is forgotten
    throw;
  }
}

Image Renderer::image(int index) {
  Image image;
  const FrameStatus status = frame(
      index, [&](int width, int height) { image = Image(width, height, source_->config().channels); },
      [&](int y, std::span<const std::uint8_t> line) {
        std::copy(line.begin(), line.end(), image.data.begin() + static_cast<std::ptrdiff_t>(image.index(0, y)));
      });
  if (status.error != ErrorCode::NONE) throw Error(fmt::format("frame {}: {}", index, describe(status)));
  return image;
}

}  // namespace kage
