// SPDX-License-Identifier: Apache-2.0
//
// The frame of a random run that came out different, as a stream file of its own.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>

#include "cosim/model/rtl.hpp"
#include "cosim/session/old_evidence.hpp"
#include "cosim/session/scene_run.hpp"
#include "file/shown.hpp"
#include "kage/core.hpp"
#include "stimulus/shrink.hpp"
#include "stream/finish.hpp"

namespace kage::cosim {
namespace {

/// How long a frame is made smaller.
constexpr std::chrono::seconds kShrinkTime{60};

ErrorCode error_of(const Config& config, const std::vector<std::uint32_t>& words) {
  return GoldenCore(config).frame(words, [](int, std::span<const std::uint8_t>) {}).error;
}

}  // namespace

/// Whether a frame comes out different on a new core that has it as its number `number`, which decides the stalls: as
/// kage cosim FILE runs it that is 0, and nothing is put ahead.
bool SceneRun::differs_alone(const std::vector<std::uint32_t>& words, int number, bool prelude) const {
  const Config& config = source_->config();
  const auto golden = cosim::make_golden(config);
  RtlOptions alone = rtl_;
  if (!prelude) alone.prelude = {};
  alone.text = unheard;
  const auto rtl = cores_.core(model_, config, alone);
  RunOptions options;
  options.steps = {number, 1};
  options.refusals = true;
  options.two_threads = false;
  const auto feed = [&](int, const WordSink& sink) {
    sink(words);
    return TokenCounts{};
  };
  return !cosim::run(number + 1, feed, *golden, *rtl, options).same;
}

/// A frame may come out the same as a file of its own: finds what it takes to differ, and how that is run again.
void SceneRun::look_for_needs(report::KeptRecord& kept, const Difference& difference) const {
  const int frame = difference.frame;
  const std::vector<std::uint32_t> words = source_->words(frame);
  kept.takes = "the frames before it";
  if (!difference.ahead && differs_alone(words, frame, false))
    kept.takes = "stalls of its place";
  else if (differs_alone(words, frame, true))
    kept.takes = difference.ahead ? "another frame right behind it, or stalls of its place"
                                  : "a reset or another frame right before it";
  else
    return;
  kept.in_place = true;
  kept.again = fmt::format("{} --out {} --frame {}", o_.lines.in_place, quoted(again_folder(o_.out)), frame);
}

/// Writes the frame that is wrong to a stream file, as small as it can be made and still comes out different on a new
/// core.
report::KeptRecord SceneRun::keep_frame(TempFiles& files, const Difference& difference) {
  const int frame = difference.frame;
  const Config& config = source_->config();
  const std::vector<std::uint32_t> words = difference.ahead ? rtl_.prelude(frame) : source_->words(frame);
  const ErrorCode error = error_of(config, words);
  // Another error is something else, which the frame need not have been kept for.
  const auto differs = [&](const std::vector<std::uint32_t>& w) {
    return error_of(config, w) == error && differs_alone(w, 0, false);
  };
  const auto begin = std::chrono::steady_clock::now();
  const auto more = [&] {
    if (host_.interrupted()) return false;  // what there is by then is written
    progress_->show("making the frame smaller");
    return std::chrono::steady_clock::now() - begin < kShrinkTime;
  };
  std::vector<std::uint32_t> small = words;
  const bool alone = differs(words);
  if (alone && !o_.no_shrink) small = verif::shrink(config, words, differs, more);
  progress_->clear();
  const std::string path =
      (std::filesystem::path(o_.out) / fmt::format("{}_{:04}{}", source_->name(), frame, kept_ending(difference)))
          .string();
  StreamFileWriter writer(path, config);
  writer.begin_port_frame();
  writer.words(small);
  writer.end_frame();
  kage::finish(writer, files);
  const TokenCounts counts = count_tokens(config, small);
  std::uint64_t tokens = 0;
  for (const std::uint64_t n : counts.of_kind) tokens += n;
  std::string again = "kage cosim " + quoted(path);
  again += fmt::format(" --seed {}", o_.seed);
  if (!o_.lines.rtl.empty()) again += " " + o_.lines.rtl;
  again += " --out " + quoted(again_folder(o_.out));
  report::KeptRecord kept{.file = path,
                          .ahead = difference.ahead,
                          .alone = alone,
                          .takes = std::nullopt,
                          .in_place = false,
                          .lines = counts.of_kind[static_cast<std::size_t>(Kind::EOL)],
                          .tokens = tokens,
                          .width = FrameHeader::read(small).width,
                          .words = small.size(),
                          .words_before = words.size(),
                          .again = again};
  if (!alone) look_for_needs(kept, difference);
  return kept;
}

}  // namespace kage::cosim
