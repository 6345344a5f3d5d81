// SPDX-License-Identifier: Apache-2.0
// kage merge REPORT...: the reports of all shards of a kage cosim as one.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ci.hpp"
#include "command.hpp"
#include "cosim/recall.hpp"
#include "cosim/report/cases.hpp"
#include "cosim/report/joined.hpp"
#include "cosim/report/junit.hpp"
#include "cosim/report/shards.hpp"
#include "cosim_print.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

struct MergeCommand : Options {
  std::vector<std::string> inputs;
  std::string junit;
};

/// What a shard has of a scene.
struct Part {
  const report::ShardFile* shard;
  const report::SceneRecord& scene;
};

/// Those that have frames of it.
std::vector<Part> parts_of(const std::vector<report::ShardFile>& shards, std::size_t scene) {
  std::vector<Part> parts;
  for (const report::ShardFile& s : shards)
    if (s.record.scenes[scene].frames != 0) parts.push_back({&s, s.record.scenes[scene]});
  return parts;
}

/// Those that are not there yet.
void unite(std::vector<std::string>& all, const std::vector<std::string>& more) {
  for (const std::string& text : more)
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
}

/// In the order of frames; nothing for those that were not compared.
void take_seconds(report::SceneRecord& all, const report::SceneRecord& s) {
  all.frame_seconds.resize(static_cast<std::size_t>(all.total_frames));
  auto frame = static_cast<std::size_t>(s.first_frame);
  for (const auto& seconds : s.frame_seconds) {
    all.frame_seconds[frame] = seconds;
    frame += static_cast<std::size_t>(s.frame_step);
  }
}

void take_verdicts(report::VerdictsRecord& all, const report::VerdictsRecord& v) {
  all.cached = all.cached || v.cached;
  all.taken_frames.insert(all.taken_frames.end(), v.taken_frames.begin(), v.taken_frames.end());
  all.kept += v.kept;
  if (!all.trouble) all.trouble = v.trouble;
}

/// A point that one shard reaches and another does not is reached.
void take_coverage(std::optional<report::CoverageRecord>& all, const report::CoverageRecord& c) {
  if (!all) all.emplace();
  all->frames += c.frames;
  for (const report::CoveragePointRecord& p : c.points) {
    const auto same = [&](const report::CoveragePointRecord& q) { return q.group == p.group && q.name == p.name; };
    const auto found = std::find_if(all->points.begin(), all->points.end(), same);
    if (found == all->points.end())
      all->points.push_back(p);
    else
      found->frames += p.frames;
  }
}

/// All shards' records of a scene as the record of one run. Polyhedra, which each shard tells of in its own frames,
/// stay with it, in `shards`.
report::SceneRecord merged(const std::vector<Part>& parts) {
  report::SceneRecord all;
  const report::SceneRecord& any = parts.front().scene;
  all.joined = true;
  all.scene = any.scene;
  all.total_frames = any.total_frames;
  all.own_sizes = any.own_sizes;
  all.options = any.options;
  all.config_name = any.config_name;
  all.config = any.config;
  all.seed = any.seed;
  all.degraded = any.degraded;
  for (const auto& [shard, s] : parts) {
    all.same = all.same && s.same;
    all.frames += s.frames;
    all.sizes_vary = all.sizes_vary || s.sizes_vary || s.width != any.width || s.height != any.height;
    all.width = std::max(all.width, s.width);
    all.height = std::max(all.height, s.height);
    all.pixels_compared += s.pixels_compared;
    all.spans += s.spans;
    all.span_pixels += s.span_pixels;
    all.segments += s.segments;
    all.units = std::max(all.units, s.units);
    all.cycles += s.cycles;
    all.stalls.starved += s.stalls.starved;
    all.stalls.blocked += s.stalls.blocked;
    take_seconds(all, s);
    all.each.insert(all.each.end(), s.each.begin(), s.each.end());
    take_verdicts(all.verdicts, s.verdicts);
    if (s.coverage) take_coverage(all.coverage, *s.coverage);
    all.golden_seconds += s.golden_seconds;
    all.rtl_seconds += s.rtl_seconds;
    all.build_seconds += s.build_seconds;
    unite(all.versions, s.versions);
    unite(all.pictures, s.pictures);
    unite(all.notes, s.notes);
    const auto& d = s.first_difference;
    // That of the register check, which has no frame, comes behind those of all frames.
    const auto place = [](const report::DifferenceRecord& of) { return of.frame.value_or(cosim::kMostFrames); };
    if (d && (!all.first_difference || place(*d) < place(*all.first_difference))) all.first_difference = d;
    report::ShardRecord& own = all.shards.emplace_back();
    static_cast<report::PartRecord&>(own) = static_cast<const report::PartRecord&>(s);
    own.number = shard->number;
    own.file = shard->file;
  }
  std::sort(all.each.begin(), all.each.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
  std::sort(all.verdicts.taken_frames.begin(), all.verdicts.taken_frames.end());
  return all;
}

void print_shards(const report::SceneRecord& scene, const std::string& who) {
  for (const report::ShardRecord& shard : scene.shards) {
    const auto& d = shard.first_difference;
    if (!d) continue;
    const std::string begin = fmt::format("{}shard {}/{}, first ", who, shard.number.index, shard.number.count);
    fmt::print("{}difference: {}\n", begin, shown(d->text));
    if (d->divergence) fmt::print("{}divergence: {}\n", begin, shown(d->divergence->text));
  }
}

int run(const MergeCommand& o) {
  std::optional<OutFolder> folder;
  if (!o.out.empty()) folder.emplace(o.out);
  reads_files(o.inputs);
  check_json(o, o.json);
  check_output(o.junit);
  const std::string page = o.out.empty() ? "" : (std::filesystem::path(o.out) / "report.html").string();
  refuse_twice({file_named(o.json), o.junit, page});
  TempFiles files;
  const std::vector<report::ShardFile> shards = report::read_shards(o.inputs, check_interrupt);
  const std::size_t count = shards.front().record.scenes.size();
  report::RunRecord all;
  all.merged = true;
  all.several = shards.front().record.several;
  report::JUnitWriter junit(files, o.junit, "kage cosim");
  for (std::size_t i = 0; i < count; ++i) {
    check_interrupt();
    const std::vector<Part> parts = parts_of(shards, i);
    all.scenes.push_back(merged(parts));
    std::vector<const report::SceneRecord*> scenes;
    scenes.reserve(parts.size());
    for (const Part& p : parts) scenes.push_back(&p.scene);
    report::junit_frames(junit, scenes);
  }
  junit.close();
  if (!o.out.empty()) {
    for (const report::ShardFile& s : shards) report::keep_page(page, s.file, s.record);
    report::write_joined_page(files, page, all, check_interrupt);
    all.page = page;
  }
  write_json(o.json, all, files);
  const report::TotalsRecord totals = all.totals();
  if (json_only(o.json)) return totals.same ? kSame : kDifferent;
  const report::SceneRecord& any = all.scenes.front();
  fmt::print("{}: {}{} of {} in {}{}, {}{} compared, {}, seed {}\n", totals.same ? "same" : "different",
             all.several ? counted(count, "scene") + ", " : "", counted(totals.frames, "frame"), totals.total_frames,
             counted(shards.size(), "shard"), cosim::taken_text(totals.taken),
             all.several ? "" : fmt::format("{}{}x{}, ", any.sizes_vary ? "up to " : "", any.width, any.height),
             counted(totals.pixels_compared, "pixel"), counted(totals.cycles, "cycle"), any.seed);
  for (const report::SceneRecord& scene : all.scenes) {
    if (scene.coverage) print_coverage(*scene.coverage, all.several ? scene.scene + ", " : "");
    print_shards(scene, all.several ? scene.scene + ", " : "");
  }
  if (all.page) fmt::print("report: {}\n", shown(*all.page));
  return totals.same ? kSame : kDifferent;
}

}  // namespace

void add_merge(CLI::App& app, Action& action) {
  CLI::App* c = add_command(
      app, "merge", "Join the reports of all shards of a co-simulation into one",
      "  kage cosim courtyard --shard 1/2 --json 1/cosim.json --out 1\n"
      "  kage cosim courtyard --shard 2/2 --json 2/cosim.json --out 2\n"
      "  kage merge 1/cosim.json 2/cosim.json --json cosim.json --junit cosim.xml --out joined\n"
      "The reports must be all shards of one run: the same scenes, size, configuration, seed and options.\n"
      "joined/report.html has verdict, scenes, frames and shards, with links to the shards' own pages where those\n"
      "lie beside their reports or where they were written.\n"
      "Exit code 0: all the same. 1: some different. 2: trouble.");
  const auto o = std::make_shared<MergeCommand>();
  c->add_option("REPORT", o->inputs, "what kage cosim --shard wrote by --json, of each shard")->required();
  option_json(*c, o->json);
  option_junit(*c, o->junit);
  c->add_option("--out", o->out, "folder for report.html, the page of the joined run; without it none is written")
      ->type_name("DIR");
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
