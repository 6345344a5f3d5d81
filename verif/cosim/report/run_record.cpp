// SPDX-License-Identifier: Apache-2.0
#include "cosim/report/run_record.hpp"

#include <algorithm>

namespace kage::report {
namespace {

std::optional<std::string> there(const std::string& text) { return text.empty() ? std::nullopt : std::optional(text); }

std::optional<int> there(int number) { return number < 0 ? std::nullopt : std::optional(number); }

}  // namespace

TotalsRecord RunRecord::totals() const {
  TotalsRecord t;
  for (const SceneRecord& s : scenes) {
    t.total_frames += static_cast<std::uint64_t>(s.total_frames);
    if (s.frames == 0) continue;
    t.same = t.same && s.same;
    t.frames += static_cast<std::uint64_t>(s.frames);
    t.pixels_compared += s.pixels_compared;
    t.spans += s.spans;
    t.span_pixels += s.span_pixels;
    t.segments += s.segments;
    t.cycles += s.cycles;
    t.stalls.starved += s.stalls.starved;
    t.stalls.blocked += s.stalls.blocked;
    t.cached = t.cached || s.verdicts.cached;
    t.taken += s.verdicts.taken_frames.size();
    t.kept += s.verdicts.kept;
    if (!t.trouble) t.trouble = s.verdicts.trouble;
    t.golden_seconds += s.golden_seconds;
    t.rtl_seconds += s.rtl_seconds;
    t.build_seconds += s.build_seconds;
  }
  return t;
}

const SceneRecord& RunRecord::any() const {
  return *std::find_if(scenes.begin(), scenes.end(), [](const SceneRecord& s) { return s.frames != 0; });
}

const SceneRecord* RunRecord::different() const {
  for (const SceneRecord& s : scenes)
    if (s.first_difference) return &s;
  return nullptr;
}

std::string_view RunRecord::schema() const { return regress ? kRegressSchema : merged ? kMergeSchema : kCosimSchema; }

void SceneRecord::take(const cosim::Report& report) {
  same = report.same;
  frames = report.frames;
  width = report.width;
  height = report.height;
  sizes_vary = report.pixels_compared != static_cast<std::uint64_t>(frames) * static_cast<std::uint64_t>(width) *
                                             static_cast<std::uint64_t>(height);
  pixels_compared = report.pixels_compared;
  spans = report.spans;
  span_pixels = report.span_pixels;
  segments = report.segments;
  cycles = report.cycles;
  stalls = report.stalls;
  golden_seconds = report.expected_seconds;
  rtl_seconds = report.actual_seconds;
  frame_seconds.assign(report.frame_seconds.begin(), report.frame_seconds.end());
  pictures = report.pictures;
  verdicts.taken_frames = report.taken;
  for (const cosim::FrameResult& f : report.each)
    each.push_back({.frame = f.frame,
                    .same = !report.first_difference || report.first_difference->frame != f.frame,
                    .taken = f.taken,
                    .cycles = f.cycles,
                    .stalls = f.stalls,
                    .phase_stalls = f.phase_stalls,
                    .spans = f.counts.spans,
                    .span_pixels = f.counts.span_pixels,
                    .segments = f.counts.of_kind[static_cast<std::size_t>(Kind::SEG)],
                    .words = f.counts.words});
}

std::optional<DifferenceRecord> difference_record(const std::optional<cosim::Difference>& difference,
                                                  const std::optional<cosim::Divergence>& divergence, bool searched) {
  if (!difference) return std::nullopt;
  DifferenceRecord r;
  r.frame = there(difference->frame);
  r.line = there(difference->line);
  r.x = there(difference->x);
  r.field = difference->field;
  r.expected = difference->expected;
  r.actual = difference->actual;
  r.assertion = there(difference->assertion);
  r.text = cosim::describe(*difference);
  r.searched = searched;
  if (searched && !divergence) r.no_divergence = cosim::describe_none(*difference);
  if (!divergence) return r;
  r.waveform = there(divergence->waveform);
  r.divergence = {.frame = divergence->frame,
                  .line = there(divergence->line),
                  .x = there(divergence->x),
                  .module = divergence->module,
                  .what = divergence->what,
                  .field = divergence->field,
                  .expected = divergence->expected,
                  .actual = divergence->actual,
                  .cycle = divergence->cycle,
                  .token = divergence->token,
                  .token_text = there(divergence->token_text),
                  .source = there(divergence->source),
                  .waits = there(divergence->waits),
                  .save_file = there(divergence->save_file),
                  .initial_state = divergence->initial_state,
                  .text = cosim::describe(*divergence)};
  return r;
}

}  // namespace kage::report
