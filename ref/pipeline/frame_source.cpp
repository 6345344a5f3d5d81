// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "direct/draw.hpp"
#include "kage/error.hpp"
#include "kage/pipeline.hpp"

namespace kage {
namespace {

// Words of a file's frame that go on at a time.
constexpr std::size_t kPieceWords = 4096;

void check_options(const DrawOptions& o) {
  if (o.width < 1 || o.height < 1 || o.width > kMaxSize || o.height > kMaxSize)
    throw Error(fmt::format("{}x{}: a picture has 1x1 to {}x{} pixels", o.width, o.height, kMaxSize, kMaxSize));
  if (o.frames < 0) throw Error(fmt::format("{} frames: there must be at least 1, or 0 for the scene's own", o.frames));
}

void check_index(int index, int frames) {
  if (index < 0 || index >= frames) throw Error(fmt::format("frame {}: there are {}", index, frames));
}

Config chosen(const Scene& scene, const DrawOptions& options) {
  check_options(options);
  return choose_config(scene, options).config;
}

}  // namespace

std::vector<std::uint32_t> FrameSource::words(int index) {
  std::vector<std::uint32_t> all;
  frame(index, [&](std::span<const std::uint32_t> piece) { all.insert(all.end(), piece.begin(), piece.end()); });
  return all;
}

bool FrameSource::draw(int /*index*/, const SizeSink& /*start*/, const LineSink& /*sink*/) { return false; }

SceneFrames::SceneFrames(std::shared_ptr<const Scene> scene, const Config& config, DrawOptions options)
    : scene_(std::move(scene)), config_(config), options_(std::move(options)), order_(options_.order) {
  check_options(options_);
  frames_ = options_.frames > 0 ? options_.frames : scene_->frame_count();
  if (options_.name.empty()) options_.name = scene_->name();
}

SceneFrames::SceneFrames(const std::shared_ptr<const Scene>& scene, const DrawOptions& options)
    : SceneFrames(scene, chosen(*scene, options), options) {}

SceneFrames::SceneFrames(Scene scene, const DrawOptions& options)
    : SceneFrames(std::make_shared<const Scene>(std::move(scene)), options) {}

TokenCounts SceneFrames::frame(int index, const WordSink& sink) {
  FrameParts parts;
  return make(index, sink, parts, {options_.all_spans, nullptr});
}

TokenCounts SceneFrames::frame(int index, const WordSink& sink, FrameParts& parts) {
  return make(index, sink, parts, {options_.all_spans, nullptr});
}

Provenance SceneFrames::provenance(int index, const WordSink& sink, bool all_spans) {
  FrameParts parts;
  FrameOrigins origins;
  make(index, sink, parts, {all_spans, &origins});
  return {scene_->objects(), std::move(parts.scene), std::move(parts.geometry), std::move(origins)};
}

/// Makes a frame's geometry and calls make(): errors that come before `begun` is set begin with scene and frame. Then
/// sinks say for themselves where they are.
template <class Make>
void SceneFrames::guarded(int index, FrameParts& parts, Make make) {
  check_index(index, frames_);
  const std::string where = fmt::format("{}: frame {}", options_.name, index);
  bool begun = false;
  try {
    parts.scene = scene_->frame(index, frames_);
    parts.geometry = make_geometry(parts.scene, config_, options_.width, options_.height,
                                   {.look = options_.look, .order = &order_, .shadows = &shadows_});
    make(begun);
  } catch (const TooManyFragments& e) {
    throw TooManyFragments(e.limit(), where);
  } catch (const Error& e) {
    if (begun) throw;
    throw Error(fmt::format("{}: {}", where, e.what()));
  }
}

TokenCounts SceneFrames::make(int index, const WordSink& sink, FrameParts& parts, const Wanted& wanted) {
  FrameChecker checker(config_, fmt::format("{}: frame {}", options_.name, index), 0);
  guarded(index, parts, [&](bool& begun) {
    make_frame(parts.geometry, config_, static_cast<std::uint32_t>(index),
               [&](std::span<const std::uint32_t> words) {
                 begun = true;
                 if (wanted.origins == nullptr) checker.feed(words);  // with origins the frame was checked before
                 sink(words);
               },
               {.threads = options_.threads,
                .report = &parts.polyhedra,
                .origins = wanted.origins,
                .level = options_.level,
                .polygons = &parts.polygons,
                .all_spans = wanted.all_spans});
  });
  return wanted.origins == nullptr ? checker.finish() : TokenCounts{};
}

bool SceneFrames::draw(int index, const SizeSink& start, const LineSink& sink) {
  FrameParts parts;
  return draw(index, start, sink, parts);
}

bool SceneFrames::draw(int index, const SizeSink& start, const LineSink& sink, FrameParts& parts) {
  if (!draws(config_) || options_.level != Level::spans) return false;
  guarded(index, parts, [&](bool& begun) {
    const bool drawn = draw_frame(
        parts.geometry, config_, options_.threads,
        [&] {
          begun = true;
          start(options_.width, options_.height);
        },
        sink);
    parts.blank = !drawn;
  });
  return true;
}

StreamFrames::StreamFrames(std::shared_ptr<const StreamFile> file) : file_(std::move(file)), config_(file_->config()) {}

TokenCounts StreamFrames::frame(int index, const WordSink& sink) {
  check_index(index, frames());
  TokenCounts counts;
  std::span<const std::uint32_t> words = file_->frame(index, &counts);
  std::vector<std::uint32_t> copy;
  while (!words.empty()) {
    const auto piece = words.first(std::min(words.size(), kPieceWords));
    words = words.subspan(piece.size());
    copy.assign(piece.begin(), piece.end());
    sink(copy);
  }
  return counts;
}

}  // namespace kage
