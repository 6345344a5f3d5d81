// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "kage/error.hpp"
#include "kage/pipeline.hpp"
#include "pipeline/stopwatch.hpp"

namespace kage {

Renderer::Renderer(FrameSource& source) : source_(&source), core_(source.config()) {}

FrameStatus Renderer::frame(int index, const LineSink& sink, const WordSink& words) {
  try {
    counts_ = source_->frame(index, [&](std::span<const std::uint32_t> piece) {
      if (words) words(piece);
      Stopwatch watch(seconds_);
      core_.feed(piece, watch.outside(sink));
    });
    Stopwatch watch(seconds_);
    return core_.finish(watch.outside(sink));
  } catch (...) {
    core_ = GoldenCore(source_->config());  // what came of the frame is forgotten
    throw;
  }
}

Image Renderer::image(int index) {
  Image image;
  std::vector<std::uint32_t> head;  // of the header: the picture's size
  const FrameStatus status = frame(
      index,
      [&](int y, std::span<const std::uint8_t> line) {
        if (y == 0) {
          const FrameHeader header = FrameHeader::read(head);
          image = Image(header.width, header.height, source_->config().channels);
        }
        std::copy(line.begin(), line.end(), image.data.begin() + static_cast<std::ptrdiff_t>(image.index(0, y)));
      },
      [&](std::span<const std::uint32_t> words) {
        if (head.size() < kHeaderWords)
          head.insert(head.end(), words.begin(),
                      words.begin() + static_cast<std::ptrdiff_t>(std::min(words.size(), kHeaderWords - head.size())));
      });
  if (status.error != ErrorCode::NONE) throw Error(fmt::format("frame {}: {}", index, describe(status)));
  return image;
}

}  // namespace kage
