// SPDX-License-Identifier: Apache-2.0
// kage sweep SCENE...: the trade between accuracy, speed and area, measured over configurations.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ci.hpp"
#include "command.hpp"
#include "command_lines.hpp"
#include "cosim/report/report_lock.hpp"
#include "cosim/session/option_names.hpp"
#include "cosim/session/run_page.hpp"
#include "cosim/session/source.hpp"
#include "cosim_print.hpp"
#include "explore/sweep_page.hpp"
#include "explore/sweep_points.hpp"
#include "explore/sweep_rows.hpp"
#include "explore/sweep_store.hpp"
#include "explore/swept_scenes.hpp"
#include "inputs.hpp"
#include "kage/error.hpp"
#include "progress.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "standard_files.hpp"
#include "sweep_print.hpp"
#include "terminal.hpp"
#include "text.hpp"

namespace kage::cli {
namespace {

using explore::Entry;
using explore::SweepPoint;
using explore::SweptScene;

// The value of --place without a device, and the device that it stands for: of the family whose cells are counted.
constexpr const char* kPlaceFlag = "true";
constexpr const char* kPlaceDevice = "ecp5-85f";

struct SweepCommand : explore::SweepOptions {
  cosim::Shard shard;
  bool resume = false;
  std::vector<std::string> take;
  std::string csv;
  std::string out;
  std::string json;
  std::string again;  // the command line that makes the same page of the store
};

/// Whether `--csv -` claims standard output for itself.
bool csv_only(const SweepCommand& o) { return is_standard_output(o.csv); }

/// The command line that draws what a point's pictures are, with its parameters in a file.
std::string render_line(const SweepCommand& o, const SweptScene& s, const SweepPoint& p) {
  std::string line =
      fmt::format("kage render {} --config {} --degrade --size {}x{} --frames {} --order {}", kage::quoted(s.input),
                  explore::kPageConfig, p.width, p.height, s.scene->frames(), cosim::name_of(p.look.translucent));
  line += fmt::format(" --sub-bits {} --samples {} --classes {} --max-shading {} --seed {}", p.look.sub_bits,
                      p.look.samples, p.look.classes, p.look.max_shading, p.look.seed);
  if (o.alpha != 1) line += fmt::format(" --alpha {}", o.alpha);
  if (o.cull) line += " --cull";
  if (o.max_fragments) line += fmt::format(" --max-fragments {}", *o.max_fragments);
  if (o.allow_outside) line += " --allow-outside";
  return line;
}

/// The folder of --out, held for this run alone, with one for pictures in it, and what draws plots: made before the
/// work, so that what cannot be is said before it.
struct OutPlace {
  explicit OutPlace(const std::string& path)
      : folder(path), pictures(std::filesystem::path(path) / explore::kPicturesFolder), lock(path) {
    plot::load();
  }
  OutFolder folder;
  OutFolder pictures;
  report::ReportLock lock;
};

/// Writes the page of --out.
void write_page(const SweepCommand& o, const std::vector<SweptScene>& scenes, const std::vector<Entry>& entries,
                const std::vector<Json>& rows, TempFiles& files) {
  Progress progress;
  explore::SweepPage page;
  page.command = o.again;
  page.store = o.store;
  page.doing = [&progress](const std::string& what) {
    check_interrupt();
    progress.show("sweep: " + what);
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SweptScene& s = scenes[entries[i].scene];
    const SweepPoint& p = s.points[entries[i].point];
    page.rows.push_back({rows[i], &p, s.scene.get(), render_line(o, s, p)});
  }
  explore::write_sweep_page(files, o.out, page);
  progress.clear();
}

std::vector<Entry> entries_of(const SweepCommand& o, const std::vector<SweptScene>& scenes) {
  std::vector<Entry> out;
  int number = 0;
  for (std::size_t s = 0; s < scenes.size(); ++s)
    for (std::size_t p = 0; p < scenes[s].points.size(); ++p)
      if (number++ % o.shard.count == o.shard.index - 1) out.push_back({s, p, {}});
  return out;
}

int list(const std::vector<SweptScene>& scenes, const std::vector<Entry>& entries) {
  for (const Entry& e : entries) {
    const SweepPoint& p = scenes[e.scene].points[e.point];
    fmt::print("{}: {}{}{}\n", scenes[e.scene].scene->name(), p.axis, p.value.empty() ? "" : " ", p.value);
  }
  return kSame;
}

/// Says how many cores are going to be placed, as that takes minutes a core.
void announce_places(explore::Placer& placer, const std::vector<SweptScene>& scenes,
                     const std::vector<Entry>& entries) {
  std::vector<Config> cores;
  for (const Entry& e : entries) {
    const Config& config = scenes[e.scene].points[e.point].config;
    if (explore::is_built(config)) cores.push_back(config);
  }
  const std::size_t missing = placer.expect(cores);
  if (missing > 0)
    say(fmt::format("kage: up to {} to be placed on {}, one after another, which takes a minute to some minutes each\n",
                    counted(missing, "core is", "cores are"), placer.device()));
}

/// Says of scenes without a soft light that an axis of samples only costs.
void announce_samples(const SweepCommand& o, const std::vector<SweptScene>& scenes) {
  const bool asked = std::any_of(o.axes.begin(), o.axes.end(),
                                 [](const std::string& axis) { return explore::parse_axis(axis).name == "SAMPLES"; });
  if (!asked) return;
  for (const SweptScene& s : scenes)
    if (!explore::is_soft(s))
      say(
          fmt::format("kage: {}: no light is soft, so SAMPLES changes no picture: what it adds to COUNT_BITS only "
                      "costs\n",
                      s.scene->name()));
}

/// Says which combinations of a grid there are none of.
void announce_left_out(const std::vector<SweptScene>& scenes) {
  for (const SweptScene& s : scenes)
    if (!s.left_out.empty()) say(fmt::format("kage: {}: {}\n", s.scene->name(), s.left_out));
}

/// The closing lines: how many rows were measured, how many came from the store, and which files were written.
std::string closing(const SweepCommand& o, std::size_t made, std::size_t rows, const std::string& page) {
  std::string text = fmt::format("# {} measured now, ", made);
  text += made == rows ? fmt::format("kept in {}\n", shown(o.store))
                       : fmt::format("{} {} in {}\n", counted(rows - made, "other"), rows - made == 1 ? "was" : "were",
                                     shown(o.store));
  if (!file_named(o.csv).empty()) text += fmt::format("# csv: {}\n", shown(o.csv));
  return page.empty() ? text : text + fmt::format("# page: {}\n", shown(page));
}

/// Throws Error where a store cannot be used: before the work, and before one is made.
void check_stores(const SweepCommand& o) {
  for (const std::string& other : o.take) explore::SweepStore::check(other);
  if (o.list) return;
  check_output(o.store);
  if (o.resume || !std::filesystem::exists(o.store) || explore::SweepStore::is_empty(o.store)) return;
  explore::SweepStore::check(o.store);
  throw Error(fmt::format("{}: there is a store already: --resume goes on with it, --store names another", o.store));
}

int run(SweepCommand& o) {
  if (o.place == kPlaceFlag) o.place = kPlaceDevice;
  o.build = build_name();
  if (o.grid && o.axes.empty()) throw Error("--grid: of the axes that --axes names, and there is none");
  const std::string page = o.out.empty() ? "" : (std::filesystem::path(o.out) / explore::kPageName).string();
  if (csv_only(o) && json_only(o.json)) throw Error("--csv - and --json -: both are standard output");
  refuse_twice({file_named(o.json), file_named(o.csv), o.store, page});
  reads_files(o.take);
  reads_files(o.inputs);
  check_json(o, o.json);
  check_output(file_named(o.csv));
  check_stores(o);
  Progress progress;
  std::vector<SweptScene> scenes;
  explore::Told* telling = nullptr;
  const explore::Tools tools = explore::tools_of(o, terminal());
  refuse_repeated(o.inputs);
  const auto doing = [&telling](const std::string& what) { telling->doing(what); };
  for (const std::string& input : o.inputs) {
    refuse_random(input);
    scenes.push_back(explore::open_swept(o, tools, input, terminal(), progress, doing));
  }
  progress.clear();
  std::vector<Entry> entries = entries_of(o, scenes);
  announce_left_out(scenes);
  if (o.list) return list(scenes, entries);
  std::optional<OutPlace> place;
  if (!o.out.empty()) {
    place.emplace(o.out);
    check_output(page);
  }
  announce_samples(o, scenes);
  if (tools.placer) announce_places(*tools.placer, scenes, entries);
  explore::SweepStore store(o.store);
  for (const std::string& other : o.take) store.absorb(other);
  explore::Told told(terminal());
  telling = &told;
  explore::Sweep sweep(o, tools, scenes, store, told, terminal());
  try {
    sweep.announce_old(entries);
    sweep.run(entries);
  } catch (const Interrupted&) {
    say(fmt::format("kage: {} kept in {}: --resume goes on from there\n",
                    counted(sweep.measured(), "run is", "runs are"), o.store));
    throw;
  }
  std::vector<Json> rows;
  for (const Entry& e : entries) rows.push_back(e.row);
  const std::vector<bool> best = explore::pareto(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i]["pareto"] = static_cast<bool>(best[i]);
  TempFiles files;
  if (!file_named(o.csv).empty()) write_text(files, o.csv, sweep_csv(rows));
  if (!o.out.empty()) write_page(o, scenes, entries, rows, files);
  finish(o.json, {explore::kRows, Json(rows)}, files,
         csv_only(o) ? sweep_csv(rows) : sweep_table(rows) + closing(o, sweep.measured(), rows.size(), page));
  return kSame;
}

}  // namespace

void add_sweep(Program& program, Action& action) {
  Command c = program.add("sweep", "Measure accuracy, speed and area over configurations",
                          "  kage sweep courtyard\n"
                          "  kage sweep courtyard --no-area --no-cosim --csv trade.csv\n"
                          "  kage sweep penumbra --axes SAMPLES=1,4,15,64 --axes Z_BITS=12,16,20,24 --json -\n"
                          "  kage sweep courtyard --axes Z_BITS=12,16 --axes LANES=1,4,16 --grid\n"
                          "  kage sweep courtyard --axes LANES=1,4,16 --place\n"
                          "  kage sweep courtyard --config plan --axes Z_BITS=16,18,20 --store plan.sqlite\n"
                          "  kage sweep courtyard --resume --out trade\n"
                          "Each row is in the store as soon as it is measured; docs/sweep.md says how each figure is.");
  const auto o = std::make_shared<SweepCommand>();
  o->size = {320, 240};
  option_scenes(c, o->inputs);
  c.add_option("--axes", o->axes,
               "an axis and its values, each of which is measured alone about the base: a parameter of the core, "
               "SUB_BITS, SAMPLES, CLASSES, MAX_SHADING, ORDER or SIZE. Default: some 60 configurations")
      .expected(1)
      .take_all()
      .type_name("AXIS=V,...");
  c.add_flag("--grid", o->grid, "every combination of the values of --axes");
  c.add_option("--seeds", o->seeds, "so many patterns of the samples of soft lights, default 1")
      .check(whole_number(1, 1000))
      .type_name("N");
  option_config(c, *o);
  c.add_option("--store", o->store, "the SQLite file that keeps the results, default sweep.sqlite").type_name("FILE");
  c.add_flag("--resume", o->resume, "go on with a store: what it has is not measured again");
  c.add_option("--take", o->take, "take the results of other stores, as of other shards")
      .expected(1)
      .take_all()
      .type_name("FILE");
  option_shard(c, o->shard, "run the Ith of N parts of the list: run I - 1 and every Nth after it. --take joins them");
  c.add_option("--jobs", o->jobs, "runs at a time, default: one per processor. Measurements of time run alone")
      .check(whole_number(1, 1024))
      .type_name("N");
  c.add_flag("--no-area", o->no_area, "estimate look-up tables and flip-flops: yosys takes half a minute for a core");
  c.add_flag("--no-cosim", o->no_cosim, "take clocks from the design: an RTL model takes a minute to build");
  c.add_flag("--no-flip", o->no_flip, "leave out FLIP");
  c.add_flag("--place", o->place,
             "place each core and tell its clock, a minute to some minutes each: on ecp5-85f, or --place=DEVICE of "
             "constraints/devices.yaml")
      .type_name("[=DEVICE]");
  c.add_flag("--list", o->list, "print what would be measured, and measure nothing");
  c.add_option("--csv", o->csv, "write the rows as CSV; - is standard output, with nothing else on it")
      .type_name(std::string("FILE") + kOrStandardOutput);
  c.add_option("--out", o->out,
               fmt::format("folder for {}, the page of all rows with their pictures, on which the cheapest "
                           "configuration within limits is found, and for plots of error against cost as SVG and PNG",
                           explore::kPageName))
      .type_name("DIR");
  options_of_pictures(c, *o, "two, or the scene's one");
  option_json(c, o->json);
  c.callback([o, &action, c] {
    // The store has all rows of the page, those that --take brought too.
    o->again = fmt::format("{} --store {} --resume", command_line(c, {"--store", "--resume", "--take"}),
                           kage::quoted(o->store));
    action = [o] { return run(*o); };
  });
}

}  // namespace kage::cli
