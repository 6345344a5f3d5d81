// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/scene_run.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "cosim/model/rtl.hpp"
#include "file/shown.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::cosim {
namespace {

/// Memory that a job may take: its model, golden core, words on their way and share of the scene.
constexpr std::uint64_t kJobBytes = std::uint64_t{256} << 20;

/// Bytes of what the RTL writes that a range keeps.
constexpr std::size_t kMostRtlText = std::size_t{1} << 20;

/// The command lines of one scene, since kage explain takes one.
CommandLines lines_of(const CosimOptions& o) {
  CommandLines lines = o.lines;
  if (o.scene) return lines;
  lines.explain = "kage explain " + quoted(o.input) + (lines.explain.empty() ? "" : " " + lines.explain);
  return lines;
}

}  // namespace

int default_jobs() {
  cpu_set_t set;
  const int processors = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  const auto memory = static_cast<std::uint64_t>(std::max(0L, sysconf(_SC_PHYS_PAGES))) *
                      static_cast<std::uint64_t>(std::max(0L, sysconf(_SC_PAGESIZE)));
  return std::clamp(processors, 1, static_cast<int>(std::clamp<std::uint64_t>(memory / 2 / kJobBytes, 1, 4096)));
}

SceneRun::SceneRun(const CosimOptions& o, Host& host, Cores& cores, std::int64_t frames_before)
    : host_(host),
      cores_(cores),
      o_(o),
      rtl_(rtl_options(o.rtl, o.seed)),
      source_(std::make_unique<Source>(o, host)),
      total_(source_->frames()),
      before_(frames_before),
      steps_{o.shard.first(frames_before), o.shard.count},
      progress_(host.progress()) {
  if (o_.frame >= 0) {
    if (o_.shard.given) throw Error("--frame and --shard: one frame has no shards");
    if (o_.frame >= total_)
      throw Error(fmt::format("{}: --frame {}: there are {}, from 0 on", o_.input, o_.frame, counted(total_, "frame")));
    steps_ = {o_.frame, 1};
  }
  // Each scene has its own folder, where there are several.
  if (o_.inputs.size() > 1 && !o_.out.empty()) o_.out = (std::filesystem::path(o_.out) / source_->name()).string();
  rtl_.prelude = source_->prelude();
}

void SceneRun::prepare(int ranges) {
  if (frames() == 0) return;
  if (!o_.out.empty()) folder_ = std::make_unique<OutFolder>(o_.out);
  open_verdicts();
  if (!recall_) model_ = cores_.model(source_->named_config(), o_.rtl, host_);
  frame_progress_.emplace(*progress_, source_->name(), frames());
  if (!o_.no_report && !o_.out.empty()) report_.emplace(*source_, lines_of(o_), host_);
  const int end = o_.frame >= 0 ? o_.frame + 1 : total_;
  for (const FrameRange& range : cosim::split(steps_, end, ranges)) parts_.push_back(part_of(range));
}

std::unique_ptr<SceneRun::Part> SceneRun::part_of(const FrameRange& range) const {
  auto part = std::make_unique<Part>();
  part->range = range;
  if (range.before == 0) return part;
  part->share = source_->share(range.steps.first - range.steps.step);
  if (report_) part->ear = std::make_unique<Listener>(*part->share);
  return part;
}

void SceneRun::run(int range) {
  Part& part = *parts_[static_cast<std::size_t>(range)];
  try {
    part.report = recall_ ? recall(part) : simulate(part, part.range);
    if (part.begun > part.report.frames) count_again(part);
    if (!part.report.same) state_.ends_at(part.report.first_difference->frame);
  } catch (const std::system_error& e) {
    if (e.code() != std::errc::resource_unavailable_try_again) {  // not a thread's: a file's
      part.error = std::current_exception();
      state_.ends_at(part.range.steps.first);
      return;
    }
    const std::string why =
        fmt::format("the system gives no room for another job ({}): fewer --jobs", e.code().message());
    part.error = std::make_exception_ptr(Error(why));
    state_.ends_at(part.range.steps.first);
  } catch (...) {
    part.error = std::current_exception();
    state_.ends_at(part.range.steps.first);
  }
}

/// The options that all ways to run a range's frames have in common.
RunOptions SceneRun::run_options(const FrameRange& range, TempFiles& files) {
  RunOptions options;
  options.out = o_.out;
  options.name = source_->name();
  options.files = &files;
  options.steps = range.steps;
  options.before = range.before;
  options.refusals = source_->may_be_refused();
  options.all_pictures = !source_->is_random();
  options.two_threads = o_.threads != 1;
  options.begin = [this, first = range.steps.first](int frame) {
    host_.check();
    if (state_.beyond(frame)) throw Enough();
    if (frame > first && o_.enough && o_.enough()) throw Enough();
    if (frame < first || o_.silent) return;
    const std::lock_guard lock(progress_mutex_);
    frame_progress_->next();
  };
  options.wait = [this] {
    host_.check();
    if (o_.silent) return;
    const std::lock_guard lock(progress_mutex_);
    frame_progress_->wait();
  };
  return options;
}

/// The frames of the range's own, of which report and coverage are told.
Feed SceneRun::heard_feed(Part& part) {
  Source& source = source_of(part);
  Listener* const ear = !report_ ? nullptr : part.ear ? part.ear.get() : &report_->listener();
  if (o_.coverage) part.coverage = std::make_unique<verif::Coverage>(source_->config(), source_->level());
  return [&part, &source, ear, first = part.range.steps.first](int i, const WordSink& sink) {
    if (i < first) return source.frame(i, sink);
    ++part.begun;
    const WordSink heard = [&](std::span<const std::uint32_t> words) {
      if (part.coverage) part.coverage->words(words);
      sink(words);
    };
    const TokenCounts counts = ear == nullptr ? source.frame(i, heard) : ear->frame(i, heard);
    if (part.coverage) part.coverage->end_frame();
    return counts;
  };
}

/// Counts again for the frames that were compared alone, because frames are made ahead of those, and how far is chance.
void SceneRun::count_again(Part& part) {
  const FrameSteps steps = part.range.steps;
  Source& source = source_of(part);
  source.count_anew(steps.first - steps.step);
  if (part.coverage) part.coverage = std::make_unique<verif::Coverage>(source.config(), source.level());
  for (int i = 0; i < part.report.frames; ++i) {
    (void)source.frame(steps.first + i * steps.step, [&](std::span<const std::uint32_t> words) {
      if (part.coverage) part.coverage->words(words);
    });
    if (part.coverage) part.coverage->end_frame();
  }
}

/// random:mixed reads and writes registers too, once in a run, behind the frames of all ranges.
void SceneRun::check_registers(Report& report) {
  if (!rtl_.prelude || !report.same || report.frames == 0) return;
  const auto wait = [this] {
    host_.check();
    if (o_.enough && o_.enough()) throw Enough();
  };
  RtlOptions options = rtl_;
  if (o_.silent) options.text = unheard;  // a silent run is made again if it comes out different
  try {
    report.first_difference = cores_.registers(model_, source_->config(), options, wait);
  } catch (const Enough&) {
    return;  // the run ends with what its frames have shown
  }
  report.same = !report.first_difference;
}

Report SceneRun::simulate(Part& part, const FrameRange& range) {
  const auto golden = cosim::make_golden(source_->config());
  RunOptions options = run_options(range, part.files);
  return run_rtl(part, range, heard_feed(part), *golden, options);
}

/// One job passes on the RTL's text at once. Each of several jobs keeps it, so that join() can pass it on in the order
/// of frames, and nothing of frames behind the first difference. A silent run is made again if it comes out different.
void SceneRun::take_rtl_text(Part& part, std::string_view text) const {
  if (o_.silent) return;
  if (o_.jobs == 1)
    host_.say(std::string(text));
  else if (part.rtl_text.size() < kMostRtlText && part.rtl_text.size() + text.size() >= kMostRtlText)
    part.rtl_text += "\n... (from here on --jobs 1 tells what the RTL writes)\n";
  else if (part.rtl_text.size() < kMostRtlText)
    part.rtl_text += text;
}

/// On a new core; the first frame of all on one with another initial state besides.
Report SceneRun::run_rtl(Part& part, const FrameRange& range, const Feed& feed, Core& golden, RunOptions& options) {
  const Config& config = source_->config();
  const std::size_t text_before = part.rtl_text.size();
  RtlOptions own_state = rtl_;
  own_state.text = [&](int frame, std::string_view text) {
    if (frame >= range.steps.first) take_rtl_text(part, text);
  };
  const auto rtl = cores_.core(model_, config, own_state);
  std::unique_ptr<Core> other;
  std::string other_text;
  if (range.steps.first == steps_.first) {
    RtlOptions other_state = rtl_;
    other_state.initial = kOtherState;
    other_state.text = [&](int, std::string_view text) {
      if (other_text.size() < kMostRtlText) other_text += text;
    };
    other = cores_.core(model_, config, other_state);
    options.other_state = other.get();
  }
  Report report = cosim::run(range.end, feed, golden, *rtl, options);
  if (report.broken) part.rtl_text.resize(text_before);  // these frames are run again
  if (report.first_difference && report.first_difference->other_state) take_rtl_text(part, other_text);
  return report;
}

Report SceneRun::settled(Report report) {
  if (report.broken)
    throw Error("a frame fails only behind all frames before it, so no range of frames shows it: run it with --jobs 1");
  return report;
}

/// The report that one thread would have made, and its files.
Report SceneRun::join(TempFiles& files) {
  std::vector<Report> reports;
  bool whole = false;  // ranges are run anew, from the first frame on
  for (auto& part : parts_) {
    const bool ahead = part->range.before == 0;
    if (part->error && !(whole && !ahead)) {
      host_.say(part->rtl_text);
      std::rethrow_exception(part->error);
    }
    // On a new core a frame comes out different, or the frame before the range fails, which in its place may not: it is
    // what one job finds that counts.
    if (!ahead && (whole || part->report.broken || !part->report.same)) {
      whole = true;
      state_.goes_on();
      part = part_of(part->range);
      FrameRange range = part->range;
      range.before = frames_before(range);
      part->report = settled(simulate(*part, range));
      if (part->begun > part->report.frames) count_again(*part);
    }
    host_.say(part->rtl_text);
    files.take(part->files);
    if (part->share) source_->absorb(*part->share);
    if (part->ear) report_->listener().absorb(*part->ear);
    if (part->coverage && coverage_) coverage_->absorb(*part->coverage);
    if (part->coverage && !coverage_) coverage_ = std::move(part->coverage);
    reports.push_back(std::move(part->report));
    if (!reports.back().same) break;
  }
  parts_.clear();
  return cosim::join(std::move(reports));
}

}  // namespace kage::cosim
