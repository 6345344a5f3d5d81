// SPDX-License-Identifier: Apache-2.0
// kage sweep SCENE...: the trade between accuracy, speed and area, measured over configurations.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "ci.hpp"
#include "command.hpp"
#include "cosim/model/model.hpp"
#include "cosim_print.hpp"
#include "kage/error.hpp"
#include "order_build.hpp"
#include "plan/demand.hpp"
#include "planned.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "source.hpp"
#include "standard_files.hpp"
#include "sweep_print.hpp"
#include "text.hpp"
#include "trade/placement.hpp"
#include "trade/sweep_page.hpp"
#include "trade/sweep_plan.hpp"
#include "trade/sweep_run.hpp"
#include "trade/sweep_store.hpp"
#include "trade/synthesis.hpp"
#include "workers.hpp"

namespace kage::cli {
namespace {

using trade::SweepPoint;

// Raise it when what is measured, or how, changes a row.
constexpr const char* kRows = "kage.sweep/1";

// What --place is without a device, and the device that it means: of the family whose cells are counted.
constexpr const char* kPlaceFlag = "true";
constexpr const char* kPlaceDevice = "ecp5-85f";

struct SweepCommand : Options {
  std::vector<std::string> inputs;
  std::vector<std::string> axes;
  bool grid = false;
  int seeds = 1;
  std::string store = "sweep.sqlite";
  bool resume = false;
  std::vector<std::string> take;
  std::string csv;
  Shard shard;
  int jobs = 0;
  bool no_area = false;
  bool no_cosim = false;
  bool no_flip = false;
  std::string place;  // a device; kPlaceFlag for the one of the counts
  bool list = false;
  std::string again;  ///< the command line that makes the same page of the store
};

/// A scene with its points.
struct SweptScene {
  std::string input;  ///< as the command line has it
  std::vector<SweepPoint> points;
  std::unique_ptr<trade::SweepScene> scene;
  std::unique_ptr<trade::SweepRunner> runner;
};

/// A run of the list.
struct Entry {
  std::size_t scene = 0;
  std::size_t point = 0;
  Json row;
};

/// How far it has come, told by several threads.
class Told {
 public:
  explicit Told(std::size_t runs) : runs_(runs) {}

  void doing(const std::string& what) {
    const std::lock_guard lock(mutex_);
    what_ = what;
    show();
  }
  /// A run has ended; `made`: it was not taken from the store.
  void done(bool made) {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (made) ++made_;
    show();
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    progress_.clear();
  }
  [[nodiscard]] std::size_t made() const { return made_; }

 private:
  void show() {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    std::string left;
    if (made_ > 0) {
      const double rest = seconds / static_cast<double>(made_) * static_cast<double>(runs_ - done_);
      left = rest < 90 ? fmt::format(", {:.0f} s left", rest) : fmt::format(", {:.0f} min left", rest / 60);
    }
    progress_.show(
        fmt::format("sweep: {} of {}{}{}{}", done_, counted(runs_, "run"), left, what_.empty() ? "" : "; ", what_));
  }

  std::mutex mutex_;
  Progress progress_;
  std::size_t runs_;
  std::size_t done_ = 0;
  std::size_t made_ = 0;
  std::string what_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Whether `--csv -` claims standard output for itself.
bool csv_only(const SweepCommand& o) { return is_standard_output(o.csv); }

int jobs_of(const SweepCommand& o) {
  return o.jobs > 0 ? o.jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

SweepPoint base_of(const SweepCommand& o, const Scene& scene, const DrawOptions& draw) {
  SweepPoint base;
  base.config = o.config.empty() ? choose_config(scene, draw).config : load_config(o.config).config;
  base.look = draw.look;
  base.look.fit = true;
  return trade::with(base, "SIZE", fmt::format("{}x{}", draw.width, draw.height));
}

std::vector<SweepPoint> points_of(const SweepCommand& o, const SweepPoint& given, const PlannedScene& scene) {
  SweepPoint base = given;
  base.axis = "base";
  base.value.clear();
  std::vector<trade::SweepAxis> axes;
  for (const std::string& text : o.axes) axes.push_back(trade::parse_axis(text));
  std::vector<SweepPoint> points = !axes.empty() && o.grid ? trade::grid(base, axes)
                                   : !axes.empty()
                                       ? trade::alone(base, axes)
                                       : trade::default_points(base, plan::features_of(std::span(&scene, 1)).needs);
  return trade::with_seeds(std::move(points), o.seeds);
}

/// The tools that measure, asked before anything is measured: one that is missing ends the sweep.
struct Tools {
  trade::SweepTools versions;
  std::unique_ptr<trade::Placer> placer;
};

Tools tools_of(const SweepCommand& o) {
  Tools tools;
  if (o.list) return tools;
  if (!o.no_area) tools.versions.yosys = trade::yosys_version(check_interrupt);
  if (!o.no_cosim) tools.versions.model = fmt::format("{}", fmt::join(cosim::model_tools(), "\n"));
  if (!o.place.empty())
    tools.placer = std::make_unique<trade::Placer>(o.place == kPlaceFlag ? kPlaceDevice : o.place, check_interrupt);
  return tools;
}

SweptScene open(const SweepCommand& o, const Tools& tools, const std::string& input, Progress& progress, Told*& told) {
  refuse_random(input);
  refuse_order_tree(input);
  if (is_stream_file(input)) throw Error(fmt::format("{}: a stream has its configuration already", input));
  auto scene = std::make_shared<const Scene>(Scene::load(input, {o.alpha, o.allow_outside, check_interrupt}));
  PlannedScene planned = planned_scene(o, scene, progress);
  if (planned.draw.frames == 0) planned.draw.frames = std::min(2, scene->frame_count());
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  planned.draw.threads = std::max(1, (o.threads > 0 ? o.threads : processors) / jobs_of(o));
  planned.draw.name = input;
  planned.draw.order.progress = [](double) { check_interrupt(); };
  const SweepPoint base = base_of(o, *scene, planned.draw);
  SweptScene out;
  out.input = input;
  out.points = points_of(o, base, planned);
  out.scene = std::make_unique<trade::SweepScene>(std::move(scene), planned.draw, base, check_interrupt);
  out.runner = std::make_unique<trade::SweepRunner>(
      *out.scene, out.points,
      trade::SweepHow{.area = !o.no_area,
                      .cosim = !o.no_cosim,
                      .flip = !o.no_flip,
                      .tools = tools.versions,
                      .placer = tools.placer.get(),
                      .wait = check_interrupt,
                      .doing = [&told](const std::string& what) { told->doing(what); }});
  return out;
}

Json look_json(const SweepPoint& p) {
  return {{"width", p.width},
          {"height", p.height},
          {"sub_bits", p.look.sub_bits},
          {"samples", p.look.samples},
          {"samples_drawn", trade::samples_of(p)},
          {"classes", p.look.classes},
          {"order", name_of(p.look.translucent)},
          {"seed", p.look.seed}};
}

/// A scene's name as rows, pages and plots have it: what of it is no UTF-8 is replaced, as in every JSON.
std::string readable(const std::string& name) {
  return Json::parse(Json(name).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Json row_of(const SweptScene& s, std::size_t point, const Json& measured) {
  const SweepPoint& p = s.points[point];
  Json row;
  row["scene"] = readable(s.scene->name());
  row["axis"] = p.axis;
  row["value"] = p.value;
  row["frames"] = s.scene->frames();
  row["look"] = look_json(p);
  row["config"] = cli::to_json(p.config);
  for (const char* key : {"accuracy", "speed", "area"}) row[key] = measured.at(key);
  return row;
}

/// The command line that draws what a point's pictures are, with its parameters in a file.
std::string render_line(const SweepCommand& o, const SweptScene& s, const SweepPoint& p) {
  std::string line =
      fmt::format("kage render {} --config {} --degrade --size {}x{} --frames {} --order {}", quoted(s.input),
                  trade::kPageConfig, p.width, p.height, s.scene->frames(), name_of(p.look.translucent));
  line += fmt::format(" --sub-bits {} --samples {} --classes {} --seed {}", p.look.sub_bits, p.look.samples,
                      p.look.classes, p.look.seed);
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
      : folder(path), pictures(std::filesystem::path(path) / trade::kPicturesFolder), lock(path) {
    plot::load();
  }
  OutFolder folder;
  OutFolder pictures;
  ReportLock lock;
};

/// What --out gets.
void write_page(const SweepCommand& o, const std::vector<SweptScene>& scenes, const std::vector<Entry>& entries,
                const std::vector<Json>& rows, TempFiles& files) {
  Progress progress;
  trade::SweepPage page;
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
  trade::write_sweep_page(files, o.out, page);
  progress.clear();
}

/// Makes the rows of the list, several at a time, or takes them from the store.
class Sweep {
 public:
  Sweep(const SweepCommand& o, const Tools& tools, std::vector<SweptScene>& scenes, trade::SweepStore& store,
        Told& told)
      : o_(o),
        scenes_(scenes),
        store_(store),
        told_(told),
        build_(trade::build_identity(build_name())),
        model_tools_(tools.versions.model) {
    for (SweptScene& s : scenes_)
      s.runner->keep_clocks = [this, &s](std::size_t point, const trade::ClockSample& sample) {
        store_.keep_clocks(clocks_key(s, point), sample);
      };
  }

  /// Says how many rows the store has of another build, scene or tool alone, which are of no use now.
  void announce_old(const std::vector<Entry>& entries) {
    std::map<std::string, std::size_t> counts;
    for (const Entry& e : entries) {
      const SweptScene& s = scenes_[e.scene];
      const std::string other = store_.old(s.scene->name(), trade::text_of(s.points[e.point]), made_of(s, e.point));
      if (!other.empty()) ++counts[other];
    }
    for (const auto& [other, count] : counts)
      say(fmt::format("kage: {} measured anew, because {} has {} of {}\n", counted(count, "row is", "rows are"),
                      o_.store, count == 1 ? "it" : "them", other));
  }

  void run(std::vector<Entry>& entries) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr error;
    std::mutex error_mutex;
    {
      const Workers workers(std::min(jobs_of(o_), static_cast<int>(entries.size())), [&] {
        for (std::size_t i = next++; i < entries.size(); i = next++) {
          try {
            make(entries[i]);
          } catch (...) {
            const std::lock_guard lock(error_mutex);
            if (!error) error = std::current_exception();
            next = entries.size();
          }
        }
      });
      if (workers.count() == 0)
        for (std::size_t i = next++; i < entries.size(); i = next++) make(entries[i]);
    }
    told_.clear();
    if (error) std::rethrow_exception(error);
  }

 private:
  /// All that decides the clocks of a point, but for the model, which is of the same build.
  std::string clocks_key(const SweptScene& s, std::size_t point) const {
    return trade::key_of({build_, "clocks", s.scene->identity(), std::to_string(s.scene->frames()),
                          trade::text_of(s.points[point]), model_tools_});
  }

  std::string row_key(const SweptScene& s, std::size_t point, const trade::PointWords& words) const {
    return trade::key_of({kRows, build_, s.scene->name(), s.scene->identity(), std::to_string(s.scene->frames()),
                          trade::text_of(s.points[point]), trade::text_of(s.scene->finest(s.points[point])), words.hash,
                          s.runner->clocks_text(point), o_.no_area ? "estimated" : "counted",
                          o_.no_flip ? "no flip" : "flip", s.runner->tools_text(point)});
  }

  /// What a row is made of, as a person tells one from another.
  trade::MadeOf made_of(const SweptScene& s, std::size_t point) const {
    return {.build = build_, .scene = s.scene->identity(), .tools = s.runner->tools_text(point)};
  }

  void make(Entry& e) {
    check_interrupt();
    SweptScene& s = scenes_[e.scene];
    const trade::PointWords words = s.runner->words(e.point);
    const std::string key = row_key(s, e.point, words);
    if (const auto kept = store_.run(key)) {
      e.row = row_of(s, e.point, Json::parse(*kept));
      told_.done(false);
      return;
    }
    const std::size_t stands = s.runner->representative(e.point);
    if (const auto clocks = store_.clocks(clocks_key(s, stands))) s.runner->know_clocks(stands, *clocks);
    const Json measured = s.runner->run(e.point, words);
    store_.keep_run(key, s.scene->name(), trade::text_of(s.points[e.point]), made_of(s, e.point), measured.dump());
    e.row = row_of(s, e.point, measured);
    told_.done(true);
  }

  const SweepCommand& o_;
  std::vector<SweptScene>& scenes_;
  trade::SweepStore& store_;
  Told& told_;
  std::string build_;
  std::string model_tools_;
};

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
    fmt::print("{}: {} {}\n", scenes[e.scene].scene->name(), p.axis, p.value);
  }
  return kSame;
}

/// Says how many cores are going to be placed, as that takes minutes a core.
void announce_places(trade::Placer& placer, const std::vector<SweptScene>& scenes, const std::vector<Entry>& entries) {
  std::vector<Config> cores;
  for (const Entry& e : entries) {
    const Config& config = scenes[e.scene].points[e.point].config;
    if (trade::is_built(config)) cores.push_back(config);
  }
  const std::size_t missing = placer.expect(cores);
  if (missing > 0)
    say(fmt::format("kage: up to {} to be placed on {}, one after another, which takes a minute to some minutes each\n",
                    counted(missing, "core is", "cores are"), placer.device()));
}

void refuse_store(const SweepCommand& o) {
  if (!o.resume && std::filesystem::exists(o.store))
    throw Error(fmt::format("{}: there is a store already: --resume goes on with it, --store names another", o.store));
}

int run(const SweepCommand& o) {
  if (o.grid && o.axes.empty()) throw Error("--grid: of the axes that --axes names, and there is none");
  const std::string page = o.out.empty() ? "" : (std::filesystem::path(o.out) / trade::kPageName).string();
  if (csv_only(o) && json_only(o)) throw Error("--csv - and --json -: both are standard output");
  refuse_twice({file_named(o.json), file_named(o.csv), o.store, page});
  check_json(o);
  check_output(file_named(o.csv));
  refuse_inputs({file_named(o.json), file_named(o.csv), o.store}, o.take);
  for (const std::string& other : o.take)
    if (!std::filesystem::exists(other)) throw Error(fmt::format("{}: no such file", other));
  if (!o.list) refuse_store(o);
  Progress progress;
  std::vector<SweptScene> scenes;
  Told* telling = nullptr;
  const Tools tools = tools_of(o);
  for (auto it = o.inputs.begin(); it != o.inputs.end(); ++it)
    if (std::find(o.inputs.begin(), it, *it) != it) throw Error(fmt::format("{}: given twice", *it));
  for (const std::string& input : o.inputs) scenes.push_back(open(o, tools, input, progress, telling));
  progress.clear();
  std::vector<Entry> entries = entries_of(o, scenes);
  if (o.list) return list(scenes, entries);
  std::optional<OutPlace> place;
  if (!o.out.empty()) {
    place.emplace(o.out);
    check_output(page);
  }
  if (tools.placer) announce_places(*tools.placer, scenes, entries);
  trade::SweepStore store(o.store);
  for (const std::string& other : o.take) store.absorb(other);
  Told told(entries.size());
  telling = &told;
  try {
    Sweep sweep(o, tools, scenes, store, told);
    sweep.announce_old(entries);
    sweep.run(entries);
  } catch (const Interrupted&) {
    say(fmt::format("kage: {} kept in {}: --resume goes on from there\n", counted(told.made(), "run is", "runs are"),
                    o.store));
    throw;
  }
  std::vector<Json> rows;
  for (const Entry& e : entries) rows.push_back(e.row);
  const std::vector<bool> best = trade::pareto(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i]["pareto"] = static_cast<bool>(best[i]);
  TempFiles files;
  if (!file_named(o.csv).empty()) write_text(files, o.csv, sweep_csv(rows));
  if (!o.out.empty()) write_page(o, scenes, entries, rows, files);
  finish(o, {kRows, Json(rows)}, files,
         csv_only(o)
             ? sweep_csv(rows)
             : sweep_table(rows) + fmt::format("# {} measured now, the others were in {}\n", told.made(), o.store) +
                   (page.empty() ? "" : fmt::format("# page: {}\n", page)));
  return kSame;
}

}  // namespace

void add_sweep(CLI::App& app, Action& action) {
  CLI::App* c =
      add_command(app, "sweep", "Measure accuracy, speed and area over configurations",
                  "  kage sweep courtyard\n"
                  "  kage sweep courtyard --no-area --no-cosim --csv trade.csv\n"
                  "  kage sweep penumbra --axes SAMPLES=1,4,15,64 --axes Z_BITS=12,16,20,24 --json -\n"
                  "  kage sweep courtyard --axes Z_BITS=12,16 --axes LANES=1,4,16 --grid\n"
                  "  kage sweep courtyard --axes LANES=1,4,16 --place\n"
                  "  kage sweep courtyard --resume --out trade\n"
                  "Each row is in the store as soon as it is measured; docs/sweep.md says how each figure is.");
  const auto o = std::make_shared<SweepCommand>();
  o->size = {320, 240};
  option_scenes(*c, o->inputs);
  c->add_option("--axes", o->axes,
                "an axis and its values, each of which is measured alone about the base: a parameter of the core, "
                "SUB_BITS, SAMPLES, CLASSES, ORDER or SIZE. Default: some 60 configurations")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("AXIS=V,...");
  c->add_flag("--grid", o->grid, "every combination of the values of --axes");
  c->add_option("--seeds", o->seeds, "so many patterns of the samples of soft lights, default 1")
      ->check(whole_number(1, 1000))
      ->type_name("N");
  option_config(*c, *o);
  c->add_option("--store", o->store, "the SQLite file that keeps the results, default sweep.sqlite")->type_name("FILE");
  c->add_flag("--resume", o->resume, "go on with a store: what it has is not measured again");
  c->add_option("--take", o->take, "take the results of other stores, as of other shards")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  option_shard(*c, o->shard, "run the Ith of N parts of the list: run I - 1 and every Nth after it. --take joins them");
  c->add_option("--jobs", o->jobs, "runs at a time, default: one per processor. What has to do with time runs alone")
      ->check(whole_number(1, 1024))
      ->type_name("N");
  c->add_flag("--no-area", o->no_area, "estimate look-up tables and flip-flops: yosys takes half a minute for a core");
  c->add_flag("--no-cosim", o->no_cosim, "take clocks from the design: an RTL model takes a minute to build");
  c->add_flag("--no-flip", o->no_flip, "leave out FLIP");
  c->add_flag("--place", o->place,
              "place each core and tell its clock, a minute to some minutes each: on ecp5-85f, or --place=DEVICE of "
              "constraints/devices.yaml")
      ->type_name("[=DEVICE]");
  c->add_flag("--list", o->list, "print what would be measured, and measure nothing");
  c->add_option("--csv", o->csv, "write the rows as CSV; - is standard output, with nothing else on it")
      ->type_name(std::string("FILE") + kOrStandardOutput);
  c->add_option("--out", o->out,
                fmt::format("folder for {}, the page of all rows with their pictures, on which the cheapest "
                            "configuration within limits is found, and for plots of error against cost as SVG and PNG",
                            trade::kPageName))
      ->type_name("DIR");
  options_of_pictures(*c, *o);
  option_json(*c, *o);
  c->callback([o, &action, c] {
    // The store has all rows of the page, those that --take brought too.
    o->again = fmt::format("{} --store {} --resume", command_line(*c, {"--store", "--resume", "--take"}),
                           cli::quoted(o->store));
    action = [o] { return run(*o); };
  });
}

}  // namespace kage::cli
