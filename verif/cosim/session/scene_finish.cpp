// SPDX-License-Identifier: Apache-2.0
//
// The search for a difference's cause, and the record, once a scene's frames are compared.
#include <fmt/format.h>

#include <filesystem>

#include "cosim/diverge/waveform.hpp"
#include "cosim/model/rtl.hpp"
#include "cosim/report/html.hpp"
#include "cosim/session/old_evidence.hpp"
#include "cosim/session/option_names.hpp"
#include "cosim/session/rtl_changed.hpp"
#include "cosim/session/scene_run.hpp"
#include "kage/error.hpp"

namespace kage::cosim {
namespace {

/// The options that decide words and clocks besides scene, size, configuration and seed.
report::OptionsRecord options_of(const CosimOptions& o, Level level) {
  return {.fault = o.rtl.fault,
          .netlist = o.rtl.netlist,
          .front_end = front_end_of(level),
          .idle = o.rtl.idle,
          .backpressure = o.rtl.backpressure,
          .stages = o.stages,
          .degrade = o.degrade,
          .order = name_of(o.order),
          .alpha = o.alpha,
          .cull = o.cull,
          .samples = o.samples,
          .classes = o.classes,
          .max_shading = o.max_shading,
          .sub_bits = o.sub_bits,
          .all_spans = o.all_spans};
}

}  // namespace

/// How the RTL is run again.
ReplayOptions SceneRun::replay(ModelFor what) const {
  ReplayOptions options = cosim::replay(source_->named_config(), o_.rtl, rtl_, what, host_);
  options.steps = steps_;
  options.rtl.text = unheard;
  return options;
}

/// The stage that a frame which came out different departs in first.
std::optional<Divergence> SceneRun::find_divergence(int frame, ModelFor model) {
  Source& source = *source_;
  const Config& config = source.config();
  const ReplayOptions options = replay(model);
  progress_->show("looking for the stage that differs first");
  // A netlist has no nets to watch but its ports.
  const std::string missing =
      o_.rtl.netlist.empty() ? cosim::make_rtl(options.library, config)->missing_monitors() : "";
  if (!missing.empty())
    source.note(fmt::format("the RTL has no longer the nets that these watch, and what they watch is not looked at: {}",
                            missing));
  const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  auto d = cosim::find_divergence(frame, feed, config, options);
  if (const auto provenance = d ? source.provenance(d->frame) : std::nullopt) {
    const auto sources = provenance->of_tokens(config, source.words(d->frame), {d->nth});
    if (!sources.empty()) d->source = sources.begin()->second.text();
  }
  progress_->clear();
  return d;
}

/// With --stages: the first frame of which the pixels are right and a stage is not. Each goes to a core that has seen
/// no other.
void SceneRun::check_stages(Report& report, Search& search) {
  if (!o_.stages || !report.same) return;
  Source& source = *source_;
  ReplayOptions options = replay(ModelFor::kMonitors);
  const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
  for (int i = 0; i < report.frames; ++i) {
    host_.check();
    const int frame = steps_.first + i * steps_.step;
    progress_->show(fmt::format("{}: stages of frame {}/{}", source.name(), i + 1, report.frames));
    options.steps = {frame, 1};
    search.divergence = cosim::find_divergence(frame, feed, source.config(), options);
    search.made = true;
    if (!search.divergence) continue;
    Difference d;
    d.frame = frame;
    d.line = search.divergence->line;
    d.field = "stage";
    d.remark = fmt::format("the pixels are the same, and a stage is not: {}", search.divergence->what);
    report.first_difference = d;
    report.same = false;
    break;
  }
  progress_->clear();
}

/// Writes the waveform round a divergence that was found in the run's frame `frame`, or one before it.
void SceneRun::write_waveform(TempFiles& files, Divergence& divergence, int frame, ModelFor model) {
  Source& source = *source_;
  try {
    const ReplayOptions options = replay(model);
    progress_->show("writing the waveform");
    const auto feed = [&](int i, const WordSink& sink) { return source.frame(i, sink); };
    cosim::write_waveform(
        divergence, feed, source.config(), options,
        {.path = std::filesystem::path(o_.out) / fmt::format("{}_{:04}.fst", source.name(), frame), .files = &files});
  } catch (const Error& e) {
    source.note(fmt::format("no waveform was written: {}", e.what()));
  }
  progress_->clear();
}

/// The verdict stands whatever becomes of what is said about it. False if `say` came to no end.
bool SceneRun::after_verdict(const std::function<void()>& say) {
  try {
    say();
    return true;
  } catch (const Interrupted&) {
    interrupted_ = true;
    source_->note("interrupted after the verdict");
  } catch (const std::exception& e) {
    source_->note(fmt::format("no report was written: {}", e.what()));
  }
  return false;
}

/// Looks for the stage that differs first, unless that is not wanted, and writes the waveform round it.
void SceneRun::look_into(TempFiles& files, const Report& r, Search& search) {
  if (!r.first_difference || r.first_difference->of_registers() || o_.no_divergence) return;
  if (search.divergence) {
    if (!o_.out.empty()) write_waveform(files, *search.divergence, r.first_difference->frame, ModelFor::kWaveforms);
    return;
  }
  try {
    if (!o_.out.empty()) search.model = ModelFor::kSearch;
    search.divergence = find_divergence(r.first_difference->frame, search.model);
    search.made = true;
  } catch (const Error& e) {
    progress_->clear();
    source_->note(fmt::format("the stage that differs first was not found: {}", e.what()));
  }
  if (search.divergence && !o_.out.empty())
    write_waveform(files, *search.divergence, r.first_difference->frame, search.model);
}

/// Where the monitors could not be had for the search, the page does without them too.
void SceneRun::write_page(TempFiles& files, const Report& r, const Search& search, report::SceneRecord& record) {
  const auto watch = [&] { return replay(search.model); };
  record.page = report_->write(files, o_.out, r, record, search.divergence, search.made ? watch : RunReport::Watch());
  record.page_crc32 = report::checksum(files.now(*record.page));
}

report::SceneRecord SceneRun::finish(TempFiles& files) {
  Source& source = *source_;
  if (frames() == 0) {
    report::SceneRecord none;
    none.scene = source.name();
    none.total_frames = total_;
    return none;
  }
  Report r = join(files);
  check_registers(r);
  Search search;
  check_stages(r, search);
  progress_->clear();
  remove_old_evidence(files, o_.out, source.name(), source.is_random(), steps_, r);
  if (r.first_difference && r.first_difference->other_state) rtl_.initial = kOtherState;
  report::SceneRecord record = record_of(r);
  if (r.same && !source.is_random() && !o_.silent && rtl_changed(o_.rtl))
    source.note(
        "the RTL is not the commit's, and these frames show no difference; --all-spans has the spans without effect, "
        "too, and random frames reach more than a scene does: kage cosim random:mixed, and kage regress");
  const bool whole = after_verdict([&] {
    look_into(files, r, search);
    if (r.first_difference && source.is_random() && !o_.out.empty() && !r.first_difference->of_registers())
      record.kept = keep_frame(files, *r.first_difference);
    host_.check();
  });
  record.first_difference = report::difference_record(r.first_difference, search.divergence, search.made);
  if (whole && report_) (void)after_verdict([&] { write_page(files, r, search, record); });
  progress_->clear();
  record.notes = source.notes();
  for (const std::string& note : record.notes) notes_.push_back(fmt::format("{}: {}", source.name(), note));
  report_.reset();
  source_.reset();  // its memory
  return record;
}

/// All of it but what is found out about a difference, the page, and the notes.
report::SceneRecord SceneRun::record_of(const Report& r) const {
  const Source& source = *source_;
  report::SceneRecord record;
  record.take(r);
  record.scene = source.name();
  record.total_frames = source.frames();
  record.first_frame = steps_.first;
  record.frame_step = steps_.step;
  if (o_.shard.given) record.shard = {o_.shard.index, o_.shard.count};
  record.options = options_of(o_, source.level());
  record.own_sizes = source.is_random() || source.is_stream();
  record.units = static_cast<std::uint64_t>(source.units());
  record.ways = source.ways();
  record.verdicts = verdicts_of(r);
  record.build_seconds = model_.build_seconds;
  record.config_name = source.named_config().name;
  record.config = source.config();
  record.seed = o_.seed;
  record.versions = versions();
  record.again = o_.lines.again;
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

}  // namespace kage::cosim
