// SPDX-License-Identifier: Apache-2.0
#include "cosim/recall.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "cosim/model/sha256.hpp"
#include "pipeline/frame_picture.hpp"

namespace kage::cosim {
namespace {

Stalls sum(const PhaseStalls& phases) {
  Stalls all;
  for (const Stalls& s : phases) {
    all.starved += s.starved;
    all.blocked += s.blocked;
  }
  return all;
}

/// A frame as the golden model alone has it.
struct GoldenFrame {
  std::string words;
  std::string output;
  FrameEnd end;
  TokenCounts counts;
  std::unique_ptr<FramePicture> picture;
};

GoldenFrame draw(int frame, const Feed& feed, Core& golden, const RunOptions& options) {
  GoldenFrame g;
  if (!options.out.empty() && options.all_pictures)
    g.picture = std::make_unique<FramePicture>(options.out / fmt::format("{}_{:04}.png", options.name, frame));
  HeardCore heard(golden);
  const LineSink line = [&](int, std::span<const std::uint8_t> pixels) {
    if (g.picture) g.picture->line(pixels);
  };
  g.counts = feed(frame, [&](std::span<const std::uint32_t> words) {
    if (g.picture) g.picture->words(words);
    heard.feed(words, line);
  });
  g.end = heard.finish(line);
  if (g.picture) g.picture->close();
  g.words = heard.words();
  g.output = heard.output();
  return g;
}

std::string hash_of_words(int frame, const Feed& feed) {
  Sha256 hash;
  feed(frame, [&](std::span<const std::uint32_t> words) { hash.add_piece(words); });
  return hash.take();
}

void take(Stretch& stretch, int frame, GoldenFrame& golden, const Verdict& verdict, const RunOptions& options) {
  FrameResult result{
      frame, golden.end.status, golden.counts, verdict.cycles, sum(verdict.phase_stalls), verdict.phase_stalls, {},
      true};
  if (golden.picture && golden.picture->drawn()) {
    result.picture = golden.picture->path().string();
    golden.picture->hand_over(stretch.files);
  }
  stretch.report.add(result, golden.end.seconds, 0);
  if (options.same) options.same(result);
}

}  // namespace

std::string recall_context(const RtlIdentity& rtl, const RtlOptions& options) {
  Sha256 hash;
  hash.add(rtl.behaviour);
  hash.add(std::string_view(KAGE_JUDGE_HASH));
  hash.add(options.seed);
  hash.add(options.initial);
  for (const int value : {options.idle_percent, options.backpressure_percent, options.mutant})
    hash.add(static_cast<std::uint64_t>(value));
  hash.add(std::uint64_t{options.assertions});
  return hash.take();
}

std::string FrameKeys::next(int number, const std::string& words) {
  Sha256 hash;
  hash.add(context_);
  hash.add(std::uint64_t{whole_});
  hash.add(before_);
  hash.add(static_cast<std::uint64_t>(number));
  hash.add(words);
  std::string key = hash.take();
  before_ = whole_ ? key : fmt::format("{} {}", number, words);
  return key;
}

std::vector<std::unique_ptr<Stretch>> recall(const FrameRange& range, const FrameSteps& all, const Feed& feed,
                                             const Feed& before, Core& golden, const RunOptions& options,
                                             const RecallOptions& recalled) {
  const int step = range.steps.step;
  std::vector<std::unique_ptr<Stretch>> stretches;
  // The stretch that frame `i` belongs to.
  const auto stretch = [&](int i, bool taken) -> Stretch& {
    if (stretches.empty() || stretches.back()->taken != taken) {
      stretches.push_back(std::make_unique<Stretch>());
      const int behind = (i - all.first) / step;
      stretches.back()->range = {{i, step}, range.end, recalled.whole ? behind : std::min(behind, 1)};
      stretches.back()->taken = taken;
    }
    stretches.back()->range.end = i + 1;
    return *stretches.back();
  };
  int i = range.steps.first;
  try {
    FrameKeys keys(recalled);
    for (int k = range.before; k > 0; --k) (void)keys.next(i - k * step, hash_of_words(i - k * step, before));
    for (; i < range.end; i += step) {
      if (options.begin) options.begin(i);
      GoldenFrame g = draw(i, feed, golden, options);
      const auto verdict = recalled.store->find(keys.next(i, g.words));
      // The golden model may have changed since. And a frame that it refuses is no verdict, unless the run says so.
      const bool same = verdict && verdict->output == g.output && (g.end.status.width != 0 || options.refusals);
      // On one core, a frame that is run takes all those before it: so what is behind it is run as well.
      const bool taken = same && !(recalled.whole && !stretches.empty() && !stretches.back()->taken);
      Stretch& s = stretch(i, taken);
      if (taken) take(s, i, g, *verdict, options);
    }
  } catch (const Enough&) {
  } catch (const std::exception&) {
  }
  if (i < range.end) stretch(i, false).range.end = range.end;
  return stretches;
}

void HeardCore::feed(std::span<const std::uint32_t> words, const LineSink& sink) {
  words_hash_.add_piece(words);
  core_.feed(words, heard(sink));
}

FrameEnd HeardCore::finish(const LineSink& sink) {
  FrameEnd end = core_.finish(heard(sink));
  const FrameStatus& s = end.status;
  for (const std::int64_t value :
       {std::int64_t{s.width}, std::int64_t{s.height}, static_cast<std::int64_t>(s.error), std::int64_t{s.frame},
        std::int64_t{s.line}, std::int64_t{s.token}, std::int64_t{s.unit}})
    output_hash_.add(static_cast<std::uint64_t>(value));
  output_hash_.add(end.misconduct);
  words_ = words_hash_.take();
  output_ = output_hash_.take();
  return end;
}

LineSink HeardCore::heard(const LineSink& sink) {
  return [&](int y, std::span<const std::uint8_t> line) {
    output_hash_.add(static_cast<std::uint64_t>(line.size()));
    output_hash_.add_piece(line);
    sink(y, line);
  };
}

FrameEnd VerdictKeeper::finish(const LineSink& sink) {
  FrameEnd end = HeardCore::finish(sink);
  const std::lock_guard lock(mutex_);
  heard_[frame_] = {keys_.next(frame_, words()), output()};
  return end;
}

void VerdictKeeper::same(const FrameResult& result) {
  Heard heard;
  {
    const std::lock_guard lock(mutex_);
    heard = std::move(heard_.at(result.frame));
    heard_.erase(heard_.begin(), heard_.upper_bound(result.frame));
  }
  if (store_.keep(heard.key, {heard.output, result.cycles, result.phase_stalls})) ++kept_;
}

std::string taken_text(std::uint64_t taken) {
  return taken == 0 ? std::string() : fmt::format(", {} of them taken from earlier runs", taken);
}

}  // namespace kage::cosim
