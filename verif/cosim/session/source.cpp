// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "contract/kinds.hpp"
#include "cosim/session/order_build.hpp"
#include "kage/error.hpp"

namespace kage::cosim {

std::unique_ptr<Source> Source::share(int last) const {
  std::unique_ptr<Source> s(new Source(host_));
  s->options_ = options_;
  s->config_ = config_;
  s->frames_ = frames_;
  s->name_ = name_;
  s->stream_ = stream_;
  s->scene_ = scene_;
  s->random_ = random_;
  if (!random_) s->open_frames();
  s->count_anew(last);
  return s;
}

void Source::count_anew(int last) {
  last_ = last;
  made_ = blank_ = unfit_ = units_ = 0;
  ways_.clear();
  polygons_.clear();
  if (scene_) remarks_.emplace(config_.config, options_.size, options_.cull);
}

void Source::absorb(const Source& share) {
  last_ = std::max(last_, share.last_);
  made_ += share.made_;
  blank_ += share.blank_;
  unfit_ += share.unfit_;
  units_ = std::max(units_, share.units_);
  if (remarks_) remarks_->absorb(*share.remarks_);
  ways_.absorb(share.ways_);
  polygons_.absorb(share.polygons_);
}

std::function<std::vector<std::uint32_t>(int)> Source::prelude() const {
  return random_ ? random_->prelude() : nullptr;
}

Level Source::level() const {
  if (!stream_) return options_.level;
  return stream_->frame_count() > 0 ? FrameHeader::read(stream_->frame(0)).level() : Level::spans;
}

bool Source::is_unchecked(int index) const { return random_ || (stream_ && stream_->is_port_frame(index)); }

bool Source::may_be_refused() const {
  for (int i = 0; i < frames_; ++i)
    if (is_unchecked(i)) return true;
  return false;
}

std::vector<std::string> Source::notes() const {
  std::vector<std::string> all = notes_;
  if (blank_ > 0)
    all.push_back(
        fmt::format("nothing is to be seen{}: no face covers the centre of a pixel", in_frames(blank_, made_)));
  if (unfit_ > 0)
    all.push_back(
        fmt::format("drawn with one shadow volume a light sample{}: more need FSF", in_frames(unfit_, made_)));
  if (remarks_)
    for (std::string& note : remarks_->notes()) all.push_back(std::move(note));
  return all;
}

TokenCounts Source::frame(int index, const WordSink& sink) {
  again_ = index <= last_;
  const TokenCounts counts = random_   ? frame_of_chance(index, sink)
                             : stream_ ? frame_of_stream(index, sink)
                                       : frame_of_scene(index, sink);
  if (!again_) units_ = std::max(units_, counts.units);
  bool drawn = counts.made > 0;
  for (std::size_t kind = 0; kind < kKindInfo.size(); ++kind)
    drawn = drawn || (kKindInfo[kind].draws && counts.of_kind[kind] > 0);
  // A frame that a core may refuse for its header or its order says nothing of faces.
  count_frame(index, !is_unchecked(index) && !drawn);
  return counts;
}

bool Source::draw(int index, const SizeSink& start, const LineSink& sink) {
  if (!scene_frames_) return false;
  again_ = index <= last_;
  FrameParts parts;
  try {
    const bool drawn = scene_frames_->draw(
        index,
        [&](int width, int height) {
          record(index, parts);
          start(width, height);
        },
        [&](int y, std::span<const std::uint8_t> line) {
          host_.check();
          sink(y, line);
        },
        parts);
    if (drawn) count_frame(index, parts.blank);
    return drawn;
  } catch (const TooManyFragments& e) {
    refuse_fragments(fmt::format("{}: frame {}", options_.input, index), e);
  }
}

void Source::count_frame(int index, bool blank) {
  last_ = std::max(last_, index);
  if (again_) return;
  ++made_;
  if (blank) ++blank_;
}

TokenCounts Source::frame_of_stream(int index, const WordSink& sink) {
  host_.check();
  return stream_frames_->frame(index, [&](std::span<const std::uint32_t> piece) {
    host_.check();  // before anybody reads the piece: pages of a file that became shorter are lost
    sink(piece);
  });
}

TokenCounts Source::frame_of_chance(int index, const WordSink& sink) {
  host_.check();
  const std::vector<std::uint32_t> words = random_->words(index);
  sink(words);
  return count_tokens(config_.config, words);
}

TokenCounts Source::frame_of_scene(int index, const WordSink& sink) {
  FrameParts parts;
  bool recorded = false;
  try {
    const TokenCounts counts = scene_frames_->frame(
        index,
        [&](std::span<const std::uint32_t> words) {
          host_.check();
          if (!recorded) record(index, parts);
          recorded = true;
          sink(words);
        },
        parts);
    if (!again_ && options_.level == Level::polygons) polygons_.add(parts.polygons);
    return counts;
  } catch (const TooManyFragments& e) {
    refuse_fragments(fmt::format("{}: frame {}", options_.input, index), e);
  }
}

std::optional<Provenance> Source::provenance(int index) {
  if (!scene_) return std::nullopt;
  return provenance(index, options_.all_spans, [](std::span<const std::uint32_t>) {});
}

std::optional<std::vector<LeftOut>> Source::left_out(int index, const ToldHistory& kept) {
  if (!scene_ || options_.all_spans) return std::nullopt;
  std::vector<std::uint32_t> words;
  const Provenance origins = provenance(index, true, [&](std::span<const std::uint32_t> piece) {
    words.insert(words.end(), piece.begin(), piece.end());
  });
  const Config& c = config_.config;
  const PixelHistory history = explain_pixel(c, words, kept.history->x, kept.history->y);
  const auto from = origins.of_history(c, words, history);
  return kage::left_out({&history, &from}, kept);
}

Provenance Source::provenance(int index, bool all_spans, const WordSink& sink) {
  const auto taken = [&](std::span<const std::uint32_t> words) {
    host_.check();
    if (progress_) progress_->clear();
    sink(words);
  };
  try {
    return scene_frames_->provenance(index, taken, all_spans);
  } catch (const TooManyFragments& e) {
    refuse_fragments(fmt::format("{}: frame {}", options_.input, index), e);
  }
}

// The parts are complete before the frame's first words.
void Source::record(int index, const FrameParts& parts) {
  if (progress_) progress_->clear();
  if (!again_) remarks_->add(*scene_, parts.scene);
  if (!again_ && parts.geometry.left_out > 0) ++unfit_;
  const int units = config_.config.units;
  if (units == 0) {
    if (options_.units_only && !parts.geometry.polyhedra.empty())
      throw Error(fmt::format("{}: frame {}: --units-only: configuration {} has no units", name_, index, config_.name));
    return;
  }
  if (again_) return;
  const auto left_out = ways_.add(*scene_, parts, units);
  if (left_out && options_.units_only)
    throw Error(fmt::format("{}: frame {}: object '{}', component {}: {} (--units-only)", name_, index,
                            left_out->object, left_out->component, left_out->cause));
}

report::WayRecords Source::ways() const {
  if (stream_) return stream_ways_;
  if (config_.config.units == 0) return std::nullopt;
  return ways_.records();
}

}  // namespace kage::cosim
