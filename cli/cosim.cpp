// SPDX-License-Identifier: Apache-2.0
// kage cosim SCENE...: golden model against RTL, frame by frame.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "ci.hpp"
#include "command.hpp"
#include "command_lines.hpp"
#include "cosim/recall.hpp"
#include "cosim/report/cases.hpp"
#include "cosim/report/report_lock.hpp"
#include "cosim/session/session.hpp"
#include "cosim_print.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "rtl_options.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

struct CosimCommand : cosim::CosimOptions {
  std::string json;
  CiOptions ci;
  Command command;
};

/// JUnit and JSON. Throws Error if they cannot be written: then no file of the run appears, but what it found is told.
void write_reports(const CosimCommand& o, const report::RunRecord& record, TempFiles& files) {
  try {
    report::JUnitWriter junit(files, o.ci.junit, "kage cosim");
    for (const report::SceneRecord& s : record.scenes)
      if (s.frames != 0) report::junit_frames(junit, {&s});
    junit.close();
    write_json(o.json, record, files);
  } catch (const Error&) {
    for (const report::SceneRecord& s : record.scenes)
      if (s.frames != 0 && !json_only(o.json)) print_finding(s, record.several ? s.scene + ": " : "");
    throw;
  }
}

void print_scene(const CosimCommand& o, const cosim::Session& session, const report::RunRecord& record,
                 std::size_t scene) {
  const report::SceneRecord& s = record.scenes[scene];
  std::FILE* const to = json_only(o.json) ? stderr : stdout;
  for (const std::string& note : session.notes(scene)) fmt::print(to, "{}\n", note);
  if (!json_only(o.json)) print_report(s, record.several ? s.scene + ": " : "", session.folder(scene));
  // No frame is to blame, so it is the run that repeats it.
  if (!json_only(o.json) && s.first_difference && !s.first_difference->frame)
    fmt::print("that run again: {}\n", s.again);
  if (s.frames != 0) report::annotate_difference(o.ci.annotate, s, to);
}

void print_totals(const CosimCommand& o, const report::RunRecord& record) {
  const report::TotalsRecord totals = record.totals();
  fmt::print("{}: {}, {} of {}{}, {} compared, {}, seed {}\n", totals.same ? "same" : "different",
             counted(record.scenes.size(), "scene"), counted(totals.frames, "frame"), totals.total_frames,
             cosim::taken_text(totals.taken), counted(totals.pixels_compared, "pixel"), counted(totals.cycles, "cycle"),
             o.seed);
  if (record.page) fmt::print("report: {}\n", *record.page);
}

int run(CosimCommand& o) {
  const OutFolder folder(o.out);
  std::optional<report::ReportLock> lock;
  if (!o.no_report && !o.out.empty()) lock.emplace(o.out);
  reads_files(o.inputs);
  check_json(o, o.json);
  check_output(o.ci.junit);
  refuse_twice({file_named(o.json), o.ci.junit,
                o.no_report || o.out.empty() ? "" : (std::filesystem::path(o.out) / "report.html").string()});
  for (const std::string& input : o.inputs) refuse_pack(input);
  o.lines = command_lines(o.command);
  cosim::Session session(o, terminal());
  session.compare();
  TempFiles files;
  const report::RunRecord record = session.finish(files);
  write_reports(o, record, files);
  for (std::size_t i = 0; i < session.scenes(); ++i) print_scene(o, session, record, i);
  if (record.several && !json_only(o.json)) print_totals(o, record);
  if (session.interrupted()) return interrupted_code();
  return record.totals().same ? kSame : kDifferent;
}

}  // namespace

void add_cosim(Program& program, Action& action) {
  const auto command = std::make_shared<CosimCommand>();
  CosimCommand& o = *command;
  Command c = program.add(
      "cosim", "Send every frame through golden model and RTL and compare every pixel",
      "  kage cosim courtyard\n"
      "  kage cosim model.glb --size 320x240 --frames 2 --config full --out pictures\n"
      "  kage cosim courtyard.kage --json -\n"
      "  kage cosim courtyard --front-end rtl --stages   (the spans that the front end makes, token by token)\n"
      "  kage cosim courtyard --all-spans --fault wrong_compare\n"
      "  kage cosim courtyard --degrade --netlist ice40 --config tiny --size 64x48   (an FPGA's cells for the RTL)\n"
      "  kage cosim courtyard penumbra glass --size 160x120\n"
      "  kage cosim random:mixed --frames 1000 --seed 5 --config glass --coverage\n"
      "  kage cosim random:mixed --front-end rtl --frames 100\n"
      "  kage cosim courtyard --shard 2/4 --junit cosim-2.xml --json cosim-2.json   (then kage merge)\n"
      "The RTL model of a configuration is built on first use, and anew when the RTL has changed; it is kept in\n"
      "~/.cache/kage/models. All files of a run appear together at its end: the pictures and DIR/report.html, which\n"
      "has verdict, frames, clocks, and the history of each pixel that is clicked (docs/report.md). Several scenes\n"
      "have a folder each in DIR, and DIR/report.html is over all; a difference ends its scene, not the others.\n"
      "Exit code 0: the same. 1: different; expected, actual and difference pictures are in the folder. 2: trouble.");
  o.out = "out";
  option_scenes(c, o.inputs, Taken::random);
  c.add_option("--out", o.out, "folder for pictures and report.html, default out").type_name("DIR");
  options_of_frames(c, o);
  option_json(c, o.json);
  option_front_end(c, o);
  option_rtl(c, o.rtl);
  c.add_option(
       "--jobs", o.jobs,
       "RTL models that run at the same time, each with frames of its own; default one per processor, as far as "
       "half of the memory holds 256 MiB for each. The result is the same for every N, except for a defect "
       "that needs a history of several frames: only --jobs 1 gives each frame all frames before it")
      .check(whole_number(1, 4096))
      .type_name("N");
  option_cache_verdicts(c, o.cache_verdicts);
  c.add_flag("--no-divergence", o.no_divergence,
             "after a difference do not run the frame again to find the stage that differs first");
  c.add_flag("--stages", o.stages,
             "run each frame that came out the same again with monitors, and hold what passes between the RTL's "
             "modules against the golden core, token by token and pixel by pixel; slow");
  option_shard(c, o.shard);
  option_junit(c, o.ci.junit);
  option_annotate(c, o.ci.annotate);
  c.add_option("--frame", o.frame, "only this frame of each scene, on a core that has seen none before it")
      .check(whole_number(0, cosim::kMostFrames - 1))
      .type_name("K");
  c.add_flag("--no-shrink", o.no_shrink,
             "keep a random frame that comes out different as it is, not as small as it can be made in a minute");
  c.add_flag("--coverage", o.coverage, "print what the frames reach: tokens, borders and extremes of fields, errors");
  c.add_flag("--no-report", o.no_report, "write no report.html");
  o.command = c;
  c.callback([command, &action] { action = [command] { return run(*command); }; });
}

}  // namespace kage::cli
