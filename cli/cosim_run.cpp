// SPDX-License-Identifier: Apache-2.0
#include "cosim_run.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "cosim/diverge/waveform.hpp"
#include "cosim/model/rtl.hpp"
#include "cosim/report/html.hpp"
#include "cosim_registers.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "stimulus/shrink.hpp"
#include "stream/finish.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

/// The initial state in which the first frame is run besides.
constexpr std::uint64_t kOtherState = 1;

/// Memory that a job may take: its model, golden core, words on their way and share of the scene.
constexpr std::uint64_t kJobBytes = std::uint64_t{256} << 20;

/// With the new files goes what an earlier run into the folder left of frames that this one has compared: a difference
/// that is no more, or was another. Of random frames only those that differ leave a picture, and the frame itself.
void remove_old_evidence(TempFiles& files, const std::string& folder, const std::string& name, bool random,
                         cosim::FrameSteps steps, const cosim::Report& r) {
  namespace fs = std::filesystem;
  if (folder.empty()) return;
  std::vector<std::string> ends{"_expected.png", "_actual.png", "_difference.png", ".fst", ".gtkw"};
  if (random) ends.insert(ends.end(), {".png", ".kage"});
  for (int i = 0; i < r.frames; ++i)
    for (const std::string& end : ends) {
      const int frame = steps.first + i * steps.step;
      if (end == ".kage" && r.first_difference && r.first_difference->frame == frame) continue;  // it is written anew
      const fs::path path = fs::path(folder) / fmt::format("{}_{:04}{}", name, frame, end);
      std::error_code ec;
      const fs::file_type type = fs::symlink_status(path, ec).type();
      if ((type == fs::file_type::regular || type == fs::file_type::symlink) &&  // else it was not ours
          std::find(r.pictures.begin(), r.pictures.end(), path.string()) == r.pictures.end())
        files.remove(path);
    }
}

/// What decides words and clocks besides scene, size, configuration and seed.
report::OptionsRecord options_of(const CosimCommand& o) {
  return {.fault = o.rtl.fault,
          .idle = o.rtl.options.idle_percent,
          .backpressure = o.rtl.options.backpressure_percent,
          .degrade = o.degrade,
          .order = name_of(o.order),
          .alpha = o.alpha,
          .cull = o.cull,
          .samples = o.samples,
          .classes = o.classes};
}

/// Takes what the RTL writes in a frame that is run once more.
constexpr auto kTold = [](int, std::string_view) {};

/// Bytes of what the RTL writes that a range keeps.
constexpr std::size_t kMostRtlText = std::size_t{1} << 20;

/// How long a frame is made smaller.
constexpr std::chrono::seconds kShrinkTime{60};

}  // namespace

int default_jobs() {
  cpu_set_t set;
  const int processors = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
  const auto memory = static_cast<std::uint64_t>(std::max(0L, sysconf(_SC_PHYS_PAGES))) *
                      static_cast<std::uint64_t>(std::max(0L, sysconf(_SC_PAGESIZE)));
  return std::clamp(processors, 1, static_cast<int>(std::clamp<std::uint64_t>(memory / 2 / kJobBytes, 1, 4096)));
}

SceneRun::SceneRun(const CosimCommand& o, std::int64_t frames_before)
    : o_(o), source_(std::make_unique<Source>(o)), total_(source_->frames()), before_(frames_before) {
  steps_ = o_.ci.shard.steps(before_);
  if (o_.frame >= 0) {
    if (o_.ci.shard.given) throw Error("--frame and --shard: one frame has no shards");
    if (o_.frame >= total_)
      throw Error(fmt::format("{}: --frame {}: there are {}, from 0 on", o_.input, o_.frame, counted(total_, "frame")));
    steps_ = {o_.frame, 1};
  }
  // Each scene has its own folder, where there are several.
  if (o_.inputs.size() > 1 && !o_.out.empty()) o_.out = (std::filesystem::path(o_.out) / source_->name()).string();
  o_.rtl.options.seed = o_.seed;
  o_.rtl.options.prelude = source_->prelude();
}

void SceneRun::prepare(int ranges) {
  if (frames() == 0) return;
  if (!o_.out.empty()) folder_ = std::make_unique<OutFolder>(o_.out);
  open_verdicts();
  if (!recall_) model_ = model_of(source_->named_config(), o_.rtl);
  frame_progress_.emplace(progress_, source_->name(), frames());
  if (!o_.no_report && !o_.out.empty()) report_.emplace(*source_, o_.input, *o_.command);
  const int end = o_.frame >= 0 ? o_.frame + 1 : total_;
  for (const cosim::FrameRange& range : cosim::split(steps_, end, ranges)) parts_.push_back(part_of(range));
}

std::unique_ptr<SceneRun::Part> SceneRun::part_of(const cosim::FrameRange& range) const {
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
    check_registers(part);
    if (!part.report.same) state_.ends_at(part.report.first_difference->frame);
  } catch (const std::system_error& e) {
    const std::string why =
        fmt::format("the system gives no room for another job ({}): fewer --jobs", e.code().message());
    part.error = std::make_exception_ptr(Error(why));
    state_.ends_at(part.range.steps.first);
  } catch (...) {
    part.error = std::current_exception();
    state_.ends_at(part.range.steps.first);
  }
}

/// What all ways to run a range's frames have in common.
cosim::RunOptions SceneRun::run_options(const cosim::FrameRange& range, TempFiles& files) {
  cosim::RunOptions options;
  options.out = o_.out;
  options.name = source_->name();
  options.files = &files;
  options.steps = range.steps;
  options.before = range.before;
  options.refusals = source_->may_be_refused();
  options.all_pictures = !source_->is_random();
  options.two_threads = o_.threads != 1;
  options.begin = [this, first = range.steps.first](int frame) {
    check_interrupt();
    if (state_.beyond(frame)) throw cosim::Enough();
    if (frame > first && o_.enough && o_.enough()) throw cosim::Enough();
    if (frame < first || o_.silent) return;
    const std::lock_guard lock(progress_mutex_);
    frame_progress_->next();
  };
  options.wait = [this] {
    check_interrupt();
    if (o_.silent) return;
    const std::lock_guard lock(progress_mutex_);
    frame_progress_->wait();
  };
  return options;
}

/// The frames of the range's own, of which report and coverage are told.
cosim::Feed SceneRun::heard_feed(Part& part) {
  Source& source = source_of(part);
  Listener* const ear = !report_ ? nullptr : part.ear ? part.ear.get() : &report_->listener();
  if (o_.coverage) part.coverage = std::make_unique<verif::Coverage>(source_->config());
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

/// Frames are made ahead of those that are compared, how far is chance. What is told of them is told of the frames that
/// were compared, so it is counted again for these alone.
void SceneRun::count_again(Part& part) {
  const cosim::FrameSteps steps = part.range.steps;
  Source& source = source_of(part);
  source.count_anew(steps.first - steps.step);
  if (part.coverage) part.coverage = std::make_unique<verif::Coverage>(source.config());
  for (int i = 0; i < part.report.frames; ++i) {
    (void)source.frame(steps.first + i * steps.step, [&](std::span<const std::uint32_t> words) {
      if (part.coverage) part.coverage->words(words);
    });
    if (part.coverage) part.coverage->end_frame();
  }
}

/// random:mixed reads and writes registers too, once in a run.
void SceneRun::check_registers(Part& part) {
  cosim::Report& report = part.report;
  const cosim::FrameSteps steps = part.range.steps;
  if (steps.first != steps_.first || !o_.rtl.options.prelude || !report.same || report.frames == 0) return;
  check_interrupt();
  const int last = steps.first + (report.frames - 1) * steps.step;
  report.first_difference = register_difference(model_.library, source_->config(), o_.rtl.options, last);
  report.same = !report.first_difference;
}

cosim::Report SceneRun::simulate(Part& part, const cosim::FrameRange& range) {
  const auto golden = cosim::make_golden(source_->config());
  cosim::RunOptions options = run_options(range, part.files);
  return run_rtl(part, range, heard_feed(part), *golden, options);
}

/// One job tells at once what the RTL writes. Of several, each keeps it, so that join() can tell it in the order of
/// frames, and nothing of frames behind the first difference. A silent run is made again if it comes out different.
void SceneRun::take_rtl_text(Part& part, std::string_view text) const {
  if (o_.silent) return;
  if (o_.jobs == 1)
    fmt::print(stderr, "{}", text);
  else if (part.rtl_text.size() < kMostRtlText && part.rtl_text.size() + text.size() >= kMostRtlText)
    part.rtl_text += "\n... (from here on --jobs 1 tells what the RTL writes)\n";
  else if (part.rtl_text.size() < kMostRtlText)
    part.rtl_text += text;
}

/// On a new core; the first frame of all on one with another initial state besides.
cosim::Report SceneRun::run_rtl(Part& part, const cosim::FrameRange& range, const cosim::Feed& feed,
                                cosim::Core& golden, cosim::RunOptions& options) {
  const Config& config = source_->config();
  const std::size_t text_before = part.rtl_text.size();
  cosim::RtlOptions own_state = o_.rtl.options;
  own_state.text = [&](int frame, std::string_view text) {
    if (frame >= range.steps.first) take_rtl_text(part, text);
  };
  const auto rtl = cosim::make_rtl(model_.library, config, own_state);
  std::unique_ptr<cosim::RtlCore> other;
  std::string other_text;
  if (range.steps.first == steps_.first) {
    cosim::RtlOptions other_state = o_.rtl.options;
    other_state.initial = kOtherState;
    other_state.text = [&](int, std::string_view text) {
      if (other_text.size() < kMostRtlText) other_text += text;
    };
    other = cosim::make_rtl(model_.library, config, other_state);
    options.other_state = other.get();
  }
  cosim::Report report = cosim::run(range.end, feed, golden, *rtl, options);
  if (report.broken) part.rtl_text.resize(text_before);  // these frames are run again
  if (report.first_difference && report.first_difference->other_state) take_rtl_text(part, other_text);
  return report;
}

/// What one thread would have found, and its files.
cosim::Report SceneRun::join(TempFiles& files) {
  std::vector<cosim::Report> reports;
  bool whole = false;  // ranges are run anew, from the first frame on
  for (auto& part : parts_) {
    const bool ahead = part->range.before == 0;
    if (part->error && !(whole && !ahead)) {
      fmt::print(stderr, "{}", part->rtl_text);
      std::rethrow_exception(part->error);
    }
    // On a new core a frame comes out different, or the frame before the range fails, which in its place may not: it is
    // what one job finds that counts.
    if (!ahead && (whole || part->report.broken || !part->report.same)) {
      whole = true;
      state_.goes_on();
      part = part_of(part->range);
      cosim::FrameRange range = part->range;
      range.before = frames_before(range);
      part->report = simulate(*part, range);
      if (part->begun > part->report.frames) count_again(*part);
    }
    fmt::print(stderr, "{}", part->rtl_text);
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

/// How the RTL is run again.
cosim::ReplayOptions SceneRun::replay(ModelFor what) const {
  cosim::ReplayOptions options = cli::replay(source_->named_config(), o_.rtl, what);
  options.steps = steps_;
  options.rtl.text = kTold;
  return options;
}

/// The stage that a frame which came out different departs in first.
std::optional<cosim::Divergence> SceneRun::find_divergence(int frame) {
  Source& source = *source_;
  const Config& config = source.config();
  const cosim::ReplayOptions options = replay(ModelFor::kMonitors);
  progress_.show("looking for the stage that differs first");
  if (const std::string missing = cosim::make_rtl(options.library, config)->missing_monitors(); !missing.empty())
    source.note(fmt::format("the RTL has no longer the nets that these watch, and what they watch is not looked at: {}",
                            missing));
  const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  auto d = cosim::find_divergence(frame, feed, config, options);
  if (const auto provenance = d ? source.provenance(d->frame) : std::nullopt) {
    const auto sources = provenance->of_tokens(config, source.words(d->frame), {d->token});
    if (!sources.empty()) d->source = sources.begin()->second.text();
  }
  progress_.clear();
  return d;
}

/// Writes the waveform round a divergence that was found in the run's frame `frame`, or one before it.
void SceneRun::write_waveform(TempFiles& files, cosim::Divergence& divergence, int frame) {
  Source& source = *source_;
  try {
    const cosim::ReplayOptions options = replay(ModelFor::kWaveforms);
    progress_.show("writing the waveform");
    const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
    cosim::write_waveform(
        divergence, feed, source.config(), options,
        {.path = std::filesystem::path(o_.out) / fmt::format("{}_{:04}.fst", source.name(), frame), .files = &files});
  } catch (const Error& e) {
    source.note(fmt::format("no waveform was written: {}", e.what()));
  }
  progress_.clear();
}

/// Writes the frame to a stream file, as small as it can be made and still comes out different on a new core.
report::KeptRecord SceneRun::keep_frame(TempFiles& files, const cosim::Difference& difference) {
  const int frame = difference.frame;
  const Config& config = source_->config();
  const std::vector<std::uint32_t> words = source_->words(frame);
  const auto error_of = [&](const std::vector<std::uint32_t>& w) {
    return GoldenCore(config).frame(w, [](int, std::span<const std::uint8_t>) {}).error;
  };
  const ErrorCode error = error_of(words);
  const auto differs = [&](const std::vector<std::uint32_t>& w) {
    if (error_of(w) != error) return false;  // another one, which the frame need not have been kept for
    const auto golden = cosim::make_golden(config);
    cosim::RtlOptions as_file = o_.rtl.options;  // kage cosim FILE puts nothing ahead
    as_file.prelude = {};
    as_file.text = kTold;
    const auto rtl = cosim::make_rtl(model_.library, config, as_file);
    cosim::RunOptions options;
    options.refusals = true;
    options.two_threads = false;
    const auto feed = [&](int, const WordSink& sink) {
      sink(w);
      return TokenCounts{};
    };
    return !cosim::run(1, feed, *golden, *rtl, options).same;
  };
  const auto begin = std::chrono::steady_clock::now();
  const auto more = [&] {
    check_interrupt();
    progress_.show("making the frame smaller");
    return std::chrono::steady_clock::now() - begin < kShrinkTime;
  };
  std::vector<std::uint32_t> small = words;
  const bool alone = differs(words);
  if (alone && !o_.no_shrink) small = verif::shrink(config, words, differs, more);
  progress_.clear();
  const std::string path =
      (std::filesystem::path(o_.out) / fmt::format("{}_{:04}.kage", source_->name(), frame)).string();
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
  for (const char* name : kRtlOptions)
    if (const CLI::Option* option = o_.command->get_option(name); option->count() != 0)
      again += fmt::format(" {} {}", name, quoted(option->results().back()));
  return {.file = path,
          .alone = alone,
          .lines = counts.of_kind[static_cast<std::size_t>(Kind::EOL)],
          .tokens = tokens,
          .width = FrameHeader::read(small).width,
          .words = small.size(),
          .words_before = words.size(),
          .again = again};
}

report::SceneRecord SceneRun::finish(TempFiles& files) {
  Source& source = *source_;
  if (frames() == 0) {
    report::SceneRecord none;
    none.scene = source.name();
    none.total_frames = total_;
    return none;
  }
  const cosim::Report r = join(files);
  progress_.clear();
  remove_old_evidence(files, o_.out, source.name(), source.is_random(), steps_, r);
  if (r.first_difference && r.first_difference->other_state) o_.rtl.options.initial = kOtherState;
  report::SceneRecord record = record_of(r);
  std::optional<cosim::Divergence> divergence;
  bool searched = false;
  // The verdict stands whatever becomes of what is said about it.
  try {
    if (r.first_difference && !o_.no_divergence) {
      try {
        divergence = find_divergence(r.first_difference->frame);
        searched = true;
      } catch (const Error& e) {
        progress_.clear();
        source.note(fmt::format("the stage that differs first was not found: {}", e.what()));
      }
    }
    if (divergence && !o_.out.empty()) write_waveform(files, *divergence, r.first_difference->frame);
    if (r.first_difference && source.is_random() && !o_.out.empty() && r.first_difference->field != "register")
      record.kept = keep_frame(files, *r.first_difference);
    record.first_difference = report::difference_record(r.first_difference, divergence, searched);
    if (report_) {
      const auto watch = [&] { return replay(ModelFor::kMonitors); };
      // Where the monitors could not be had for the search, the page does without them too.
      record.page = report_->write(files, o_.out, r, record, divergence, searched ? watch : RunReport::Watch());
      record.page_crc32 = report::checksum(files.now(*record.page));
    }
  } catch (const Interrupted&) {
    interrupted_ = true;
    source.note("interrupted after the verdict");
  } catch (const std::exception& e) {
    source.note(fmt::format("no report was written: {}", e.what()));
  }
  progress_.clear();
  record.first_difference = report::difference_record(r.first_difference, divergence, searched);
  record.notes = source.notes();
  for (const std::string& note : record.notes) notes_.push_back(fmt::format("{}: {}", source.name(), note));
  report_.reset();
  source_.reset();  // its memory
  return record;
}

/// All of it but what is found out about a difference, the page, and the notes.
report::SceneRecord SceneRun::record_of(const cosim::Report& r) const {
  const Source& source = *source_;
  report::SceneRecord record;
  record.take(r);
  record.scene = source.name();
  record.total_frames = source.frames();
  record.first_frame = steps_.first;
  record.frame_step = steps_.step;
  if (o_.ci.shard.given) record.shard = {o_.ci.shard.index, o_.ci.shard.count};
  record.options = options_of(o_);
  record.units = static_cast<std::uint64_t>(source.units());
  record.ways = source.ways();
  record.verdicts = verdicts_of(r);
  record.build_seconds = model_.build_seconds;
  record.config_name = source.named_config().name;
  record.config = source.config();
  record.seed = o_.seed;
  record.versions = versions();
  record.again = again_line(*o_.command);
  record.folder = std::filesystem::current_path().string();
  record.rtl = rtl_directory();
  record.degraded = source.degraded();
  if (coverage_) {
    auto& coverage = record.coverage.emplace();
    coverage.frames = coverage_->frames();
    for (const verif::CoveragePoint& p : coverage_->points()) coverage.points.push_back({p.group, p.name, p.frames});
  }
  return record;
}

}  // namespace kage::cli
