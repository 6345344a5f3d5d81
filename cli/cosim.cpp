// SPDX-License-Identifier: Apache-2.0
// kage cosim SCENE...: golden model against RTL, frame by frame.
#include <fmt/format.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>

#include "ci.hpp"
#include "command.hpp"
#include "cosim/recall.hpp"
#include "cosim_print.hpp"
#include "cosim_run.hpp"
#include "joined.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "text.hpp"
#include "workers.hpp"

namespace kage::cli {
namespace {

using Scenes = std::vector<std::unique_ptr<SceneRun>>;

/// Opens all scenes, so that what cannot be read is found before the work.
Scenes open(const CosimCommand& o) {
  Scenes scenes;
  std::int64_t frames = 0;
  int own = 0;
  for (const std::string& input : o.inputs) {
    check_interrupt();
    CosimCommand with_input = o;
    with_input.input = input;
    auto scene = std::make_unique<SceneRun>(with_input, frames);
    const std::string& name = scene->source().name();
    for (const auto& other : scenes)
      if (other->source().name() == name)
        throw Error(fmt::format("{}: a scene called {} is there already: {}", input, name, other->command().input));
    frames += scene->total();
    own += scene->frames();
    scenes.push_back(std::move(scene));
  }
  if (own == 0)
    throw Error(fmt::format("--shard {}/{}: {} {} only {}", o.ci.shard.index, o.ci.shard.count,
                            scenes.size() == 1 ? scenes.front()->source().name() : "the scenes",
                            scenes.size() == 1 ? "has" : "have", counted(frames, "frame")));
  return scenes;
}

/// Compares all frames of all scenes, on so many threads.
void compare(const Scenes& scenes, int jobs) {
  // Jobs that have no scene of their own share one: its frames go to as many ranges.
  const int ranges = (jobs + static_cast<int>(scenes.size()) - 1) / static_cast<int>(scenes.size());
  std::vector<std::function<void()>> work;
  for (const auto& scene : scenes) {
    scene->prepare(ranges);
    for (int i = 0; i < scene->ranges(); ++i) work.emplace_back([&scene, i] { scene->run(i); });
  }
  std::atomic<std::size_t> next{0};
  const auto worker = [&] {
    for (std::size_t i = next++; i < work.size(); i = next++) work[i]();
  };
  const Workers others(static_cast<int>(std::min(work.size(), static_cast<std::size_t>(jobs))) - 1, worker);
  worker();
}

/// Writes the page over all scenes; its name, or nothing: the verdict stands without it.
std::optional<std::string> joined_page(const CosimCommand& o, const report::RunRecord& record, SceneRun& last,
                                       TempFiles& files) {
  std::string page = (std::filesystem::path(o.out) / "report.html").string();
  try {
    write_joined_page(files, page, record);
    return page;
  } catch (const Interrupted&) {
    last.interrupt();
    last.note("interrupted after the verdict");
  } catch (const std::exception& e) {
    last.note(fmt::format("no report over all scenes was written: {}", e.what()));
  }
  return std::nullopt;
}

int run(const CosimCommand& o) {
  const OutFolder folder(o.out);
  std::optional<ReportLock> lock;
  if (!o.no_report && !o.out.empty()) lock.emplace(o.out);
  reads_files(o.inputs);
  check_json(o);
  check_output(o.ci.junit);
  refuse_twice({file_named(o.json), o.ci.junit,
                o.no_report || o.out.empty() ? "" : (std::filesystem::path(o.out) / "report.html").string()});
  const Scenes scenes = open(o);
  compare(scenes, o.jobs > 0 ? o.jobs : default_jobs());
  TempFiles files;
  report::RunRecord record;
  record.several = scenes.size() > 1;
  for (const auto& scene : scenes) {
    record.scenes.push_back(scene->finish(files));
    if (scene->interrupted() && scene != scenes.back()) throw Interrupted{};
  }
  const auto who = [&](const report::SceneRecord& s) { return record.several ? s.scene + ": " : std::string(); };
  if (record.several && !o.no_report && !o.out.empty()) record.page = joined_page(o, record, *scenes.back(), files);
  try {
    JUnitWriter junit(files, o.ci.junit, "kage cosim");
    for (const report::SceneRecord& s : record.scenes)
      if (s.frames != 0) junit_frames(junit, {&s});
    junit.close();
    write_json(o, record, files);
  } catch (const Error&) {
    // No file of the run appears, but what it found is told.
    for (const report::SceneRecord& s : record.scenes)
      if (s.frames != 0 && !json_only(o)) print_finding(s, who(s));
    throw;
  }
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const report::SceneRecord& s = record.scenes[i];
    for (const std::string& note : scenes[i]->notes()) fmt::print(json_only(o) ? stderr : stdout, "{}\n", note);
    if (!json_only(o)) print_report(s, who(s), scenes[i]->command().out);
    // No frame is to blame, so it is the run that repeats it.
    if (!json_only(o) && s.first_difference && !s.first_difference->frame) fmt::print("that run again: {}\n", s.again);
    if (s.frames != 0) annotate_difference(o.ci.annotate, s, json_only(o) ? stderr : stdout);
  }
  const report::TotalsRecord totals = record.totals();
  if (record.several && !json_only(o)) {
    fmt::print("{}: {}, {} of {}{}, {} compared, {}, seed {}\n", totals.same ? "same" : "different",
               counted(scenes.size(), "scene"), counted(totals.frames, "frame"), totals.total_frames,
               cosim::taken_text(totals.taken), counted(totals.pixels_compared, "pixel"),
               counted(totals.cycles, "cycle"), o.seed);
    if (record.page) fmt::print("report: {}\n", *record.page);
  }
  if (scenes.back()->interrupted()) return interrupted_code();
  return totals.same ? kSame : kDifferent;
}

}  // namespace

CLI::App* cosim_command(CLI::App& app, CosimCommand& o) {
  CLI::App* c = add_command(
      app, "cosim", "Send every frame through golden model and RTL and compare every pixel",
      "  kage cosim courtyard\n"
      "  kage cosim model.glb --size 320x240 --frames 2 --config full --out pictures\n"
      "  kage cosim courtyard.kage --json -\n"
      "  kage cosim courtyard --front-end rtl --stages   (the spans that the front end makes, token by token)\n"
      "  kage cosim courtyard --fault wrong_compare\n"
      "  kage cosim courtyard --degrade --netlist ice40 --config tiny --size 64x48   (an FPGA's cells for the RTL)\n"
      "  kage cosim courtyard penumbra glass --size 160x120\n"
      "  kage cosim random:mixed --frames 1000 --seed 5 --config glass --coverage\n"
      "  kage cosim random:mixed --front-end rtl --frames 100\n"
      "  kage cosim courtyard --shard 2/4 --junit cosim-2.xml --json cosim-2.json   (then kage merge)\n"
      "The RTL model of a configuration is built on first use, and anew when the RTL has changed; it is kept in\n"
      "~/.cache/kage/models. All files of a run appear together at its end: the pictures and DIR/report.html, which\n"
      "has verdict, frames, clocks, and the history of each pixel that is clicked (docs/report.md). Of several scenes\n"
      "each has its own folder in DIR, and DIR/report.html is over all; a difference ends its scene, not the others.\n"
      "Exit code 0: the same. 1: different; expected, actual and difference pictures are in the folder. 2: trouble.");
  o.out = "out";
  option_scenes(*c, o.inputs, Taken::random);
  c->add_option("--out", o.out, "folder for pictures and report.html, default out")->type_name("DIR");
  options_of_frames(*c, o);
  option_json(*c, o);
  option_front_end(*c, o);
  option_rtl(*c, o.rtl);
  c->add_option(
       "--jobs", o.jobs,
       "RTL models that run at the same time, each with frames of its own; default one per processor, as far as "
       "half of the memory holds 256 MiB for each. The result is the same for every N, except for a defect "
       "that needs a history of several frames: only --jobs 1 gives each frame all frames before it")
      ->check(whole_number(1, 4096))
      ->type_name("N");
  option_cache_verdicts(*c, o.cache_verdicts);
  c->add_flag("--no-divergence", o.no_divergence,
              "after a difference do not run the frame again to find the stage that differs first");
  c->add_flag("--stages", o.stages,
              "run each frame that came out the same again with monitors, and hold what passes between the RTL's "
              "modules against the golden core, token by token and pixel by pixel; slow");
  option_shard(*c, o.ci.shard);
  option_junit(*c, o.ci.junit);
  option_annotate(*c, o.ci.annotate);
  c->add_option("--frame", o.frame, "only this frame of each scene, on a core that has seen none before it")
      ->check(whole_number(0, kMostFrames - 1))
      ->type_name("K");
  c->add_flag("--no-shrink", o.no_shrink,
              "keep a random frame that comes out different as it is, not as small as it can be made in a minute");
  c->add_flag("--coverage", o.coverage, "print what the frames reach: tokens, borders and extremes of fields, errors");
  c->add_flag("--no-report", o.no_report, "write no report.html");
  o.command = c;
  return c;
}

void add_cosim(CLI::App& app, Action& action) {
  const auto o = std::make_shared<CosimCommand>();
  cosim_command(app, *o)->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
