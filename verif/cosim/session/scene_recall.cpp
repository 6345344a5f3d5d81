// SPDX-License-Identifier: Apache-2.0
// CosimOptions::cache_verdicts: frames whose verdicts earlier runs have left are not run again.
#include <fmt/format.h>

#include <utility>

#include "cosim/recall.hpp"
#include "cosim/session/host.hpp"
#include "cosim/session/scene_run.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
void SceneRun::no_verdicts(std::string why) {
  no_verdicts_ = std::move(why);
  recall_.reset();
  say_once(host_,
           fmt::format("kage: note: no verdicts of earlier runs are taken, and none is kept: {}\n", no_verdicts_));
}

void SceneRun::open_verdicts() {
  if (!o_.cache_verdicts) return;
  if (!o_.rtl.fault.empty()) return no_verdicts("with --fault every frame is run");
  if (!o_.rtl.netlist.empty()) return no_verdicts("with --netlist every frame is run");
  if (rtl_.mutant != 0) return no_verdicts("with --mutant every frame is run");
  if (rtl_.prelude) return no_verdicts("random:mixed runs every frame, for other frames go ahead of its own");
  const RtlIdentity rtl = cores_.identity(source_->named_config(), host_);
  if (rtl.behaviour.empty()) return no_verdicts(rtl.why_not);
  RecallOptions recall;
  try {
    recall.store = std::make_shared<VerdictStore>();
  } catch (const Error& e) {
    return no_verdicts(e.what());
  }
  recall.context = cosim::recall_context(rtl, rtl_);
  // A defect that only a history of many frames shows is for --jobs 1.
  recall.whole = o_.jobs == 1;
  model_key_ = rtl.model_key;
  recall_ = std::move(recall);
}

/// The golden model works through all frames of the range; those without a verdict go through both cores then.
Report SceneRun::recall(Part& part) {
  const auto golden = cosim::make_golden(source_->config());
  TempFiles none;
  RunOptions options = run_options(part.range, none);
  options.begin = [this](int frame) {
    host_.check();
    if (state_.beyond(frame)) throw Enough();
  };
  options.same = [this](const FrameResult&) {
    if (o_.silent) return;
    const std::lock_guard lock(progress_mutex_);
    frame_progress_->next();
  };
  Source& source = source_of(part);
  const auto before = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  std::vector<Report> reports;
  for (const auto& s : cosim::recall(part.range, steps_, heard_feed(part), before, *golden, options, *recall_)) {
    if (!s->taken) s->report = simulate_and_keep(part, s->range, s->files);
    part.files.take(s->files);
    reports.push_back(std::move(s->report));
    // Behind a difference, or where the run was to go no further, nothing is counted.
    if (!reports.back().same || reports.back().frames < s->range.steps.below(s->range.end)) break;
  }
  return cosim::join(std::move(reports));
}

Report SceneRun::simulate_and_keep(Part& part, const FrameRange& range, TempFiles& files) {
  (void)model();
  // Report and coverage have heard of these frames already.
  Source& source = source_of(part);
  const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  const auto run = [&](const FrameRange& frames) {
    const auto golden = cosim::make_golden(source_->config());  // a run that broke off leaves it within a frame
    VerdictKeeper keeper(*golden, *recall_);
    RunOptions options = run_options(frames, files);
    options.begin = [&, begin = options.begin](int frame) {
      begin(frame);
      keeper.next(frame);
    };
    options.same = [&](const FrameResult& result) { keeper.same(result); };
    Report report = run_rtl(part, frames, feed, keeper, options);
    verdicts_kept_ += keeper.kept();
    return report;
  };
  Report report = run(range);
  if (!report.broken) return report;
  // As in join(): what fails on a new core, and not in its place, is run from the first frame.
  FrameRange whole = range;
  whole.before = frames_before(range);
  return settled(run(whole));
}

/// The model of the scene, built when the first of its frames needs it.
const Model& SceneRun::model() {
  const std::lock_guard lock(model_mutex_);
  if (model_error_) std::rethrow_exception(model_error_);
  if (!model_.library.empty()) return model_;
  try {
    Model model = cores_.model(source_->named_config(), o_.rtl, host_);
    if (model.library.stem() != model_key_)
      throw Error("the RTL was changed while verdicts were looked up: run it again");
    model_ = std::move(model);
  } catch (...) {
    model_error_ = std::current_exception();
    throw;
  }
  return model_;
}

report::VerdictsRecord SceneRun::verdicts_of(const Report& r) const {
  const std::string trouble = recall_ ? recall_->store->trouble() : no_verdicts_;
  if (recall_ && !trouble.empty()) say_once(host_, fmt::format("kage: note: verdicts are not kept: {}\n", trouble));
  return {.cached = recall_.has_value(),
          .taken_frames = r.taken,
          .kept = static_cast<std::uint64_t>(verdicts_kept_.load()),
          .trouble = trouble.empty() ? std::nullopt : std::optional(trouble)};
}

}  // namespace kage::cosim
