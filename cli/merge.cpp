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
  report::RunRecord all = report::joined_record(shards);
  report::JUnitWriter junit(files, o.junit, "kage cosim");
  for (std::size_t i = 0; i < count; ++i) {
    check_interrupt();
    report::junit_frames(junit, report::scene_of_shards(shards, i));
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

void add_merge(Program& program, Action& action) {
  Command c = program.add(
      "merge", "Join the reports of all shards of a co-simulation into one",
      "  kage cosim courtyard --shard 1/2 --json 1/cosim.json --out 1\n"
      "  kage cosim courtyard --shard 2/2 --json 2/cosim.json --out 2\n"
      "  kage merge 1/cosim.json 2/cosim.json --json cosim.json --junit cosim.xml --out joined\n"
      "The reports must be all shards of one run: the same scenes, size, configuration, seed and options.\n"
      "joined/report.html has verdict, scenes, frames and shards, with links to the shards' own pages where those\n"
      "lie beside their reports or where they were written.\n"
      "Exit code 0: all the same. 1: some different. 2: trouble.");
  const auto o = std::make_shared<MergeCommand>();
  c.add_option("REPORT", o->inputs, "what kage cosim --shard wrote by --json, of each shard").required();
  option_json(c, o->json);
  option_junit(c, o->junit);
  c.add_option("--out", o->out, "folder for report.html, the page of the joined run; without it none is written")
      .type_name("DIR");
  c.callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
