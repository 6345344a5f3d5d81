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
  } catch (...) {
    core_ = GoldenCore(source_->config());  // what came of the frame is forgotten
    throw;
  }
  Stopwatch watch(seconds_);
  return core_.finish(watch.outside(sink));
}

Image Renderer::image(int index) {
  std::vector<std::uint8_t> data;
  const FrameStatus status =
      frame(index, [&](int, std::span<const std::uint8_t> line) { data.insert(data.end(), line.begin(), line.end()); });
  if (status.error != ErrorCode::NONE) throw Error(fmt::format("frame {}: {}", index, describe(status)));
  Image image(status.width, status.height, source_->config().channels);
  image.data = std::move(data);
  return image;
}

}  // namespace kage
