// SPDX-License-Identifier: Apache-2.0
// kage regress: the recommended runs of kage cosim, in rounds, until the time is over or one comes out different.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "ci.hpp"
#include "command.hpp"
#include "cosim_print.hpp"
#include "cosim_run.hpp"
#include "joined.hpp"
#include "kage/config.hpp"
#include "kage/error.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "regress_plan.hpp"
#include "results.hpp"
#include "signals.hpp"
#include "text.hpp"
#include "workers.hpp"

namespace kage::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct RegressCommand : Options {
  std::vector<std::string> configs;
  double minutes = 5;
  int rounds = 0;  // 0: as many as the minutes hold
  int jobs = 0;    // 0: default_jobs()
  bool no_divergence = false;
  bool list = false;  // the runs are told, and none is made
  RtlRun rtl;
  CiOptions ci;
  const CLI::App* command = nullptr;
};

/// A planned run as kage cosim takes it.
struct ParsedRun {
  PlannedRun plan;
  CLI::App app;
  CosimCommand command;
  Action nothing;

  explicit ParsedRun(PlannedRun p, const std::string& out = {}) : plan(std::move(p)) {
    cosim_command(app, command);
    add_explain(app, nothing);  // the page tells its command lines
    std::vector<std::string> line = plan.arguments;
    if (!out.empty()) line.insert(line.end(), {"--out", out});
    line.insert(line.begin(), "cosim");
    std::reverse(line.begin(), line.end());  // as CLI11 takes it
    app.parse(line);
    command.input = command.inputs.front();
    command.jobs = 1;
  }
};

class Regress {
 public:
  explicit Regress(const RegressCommand& o) : o_(o), start_(Clock::now()) {
    const std::vector<std::string>& names = o_.configs;
    if (names.empty()) configs_ = named_configs();
    for (const std::string& name : names) configs_.push_back(load_config(name));
    for (const char* name : kRtlOptions)
      if (const CLI::Option* option = o_.command->get_option_no_throw(name); option != nullptr && option->count() != 0)
        more_.insert(more_.end(), {name, option->results().back()});
  }

  /// A line for each run of the first rounds: its name, and the command that it stands for.
  void list(int rounds) const {
    for (int round = 0; round < rounds; ++round)
      for (const PlannedRun& run : plan_round(configs_, round, o_.seed, more_)) {
        std::string line = run.name + ": kage cosim";
        for (const std::string& argument : run.arguments) line += " " + quoted(argument);
        fmt::print("{}\n", line);
      }
  }

  /// Builds what models are missing; then the time begins.
  void prepare() {
    (void)plan_round(configs_, 0, o_.seed, more_);
    for (const NamedConfig& c : configs_) {
      check_interrupt();
      build_seconds_ += model_of(c, o_.rtl).build_seconds;
    }
    start_ = Clock::now();
  }

  /// All runs, on so many threads.
  void run(int jobs) {
    {
      const Workers workers(jobs, [this] { work(); });
      if (workers.count() == 0) work();
      std::unique_lock lock(mutex_);
      while (ended_threads_ < workers.count()) {
        changed_.wait_for(lock, std::chrono::milliseconds(100));
        progress_.show(
            fmt::format("{}, {}, {:.0f} s", counted(done_.size(), "run"), counted(frames_, "frame"), seconds()));
      }
    }
    progress_.clear();
    if (error_) std::rethrow_exception(error_);
    // Of runs behind the first difference nothing is told: how many there are depends on the threads.
    done_.erase(done_.upper_bound(first_), done_.end());
  }

  /// The run that came out different, once more, with all that kage cosim finds out about it; its lines.
  void look_into(TempFiles& files) {
    if (first_ == kNone || interrupted_) return;
    try {
      repeat(files);
    } catch (const Interrupted&) {
      interrupted_ = true;
      notes_.emplace_back("interrupted after the verdict");
    }
  }

  [[nodiscard]] bool interrupted() const { return interrupted_; }
  [[nodiscard]] bool same() const { return first_ == kNone; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] const report::SceneRecord& different() const { return done_.at(first_).record; }

  /// What was run, and what came of it.
  [[nodiscard]] report::RunRecord record() const {
    report::RunRecord all;
    all.several = true;
    for (const auto& [index, d] : done_) all.scenes.push_back(d.record);
    if (all.scenes.empty()) throw Interrupted{};  // nothing else keeps the first run from its end
    all.regress = {.again = command_line(*o_.command),
                   .rounds = rounds_,
                   .seed = o_.seed,
                   .seconds = seconds_,
                   .build_seconds = build_seconds_,
                   .interrupted = interrupted_};
    return all;
  }

 private:
  static constexpr int kNone = std::numeric_limits<int>::max();
  struct Done {
    PlannedRun plan;
    report::SceneRecord record;
  };

  void repeat(TempFiles& files) {
    Done& d = done_.at(first_);
    const std::string folder = (std::filesystem::path(o_.out) / d.plan.name).string();
    ParsedRun again(d.plan, folder);
    again.command.no_divergence = o_.no_divergence;
    SceneRun scene(again.command, 0);
    scene.prepare(1);
    scene.run(0);
    report::SceneRecord record = scene.finish(files);
    record.scene = d.plan.name;
    notes_ = scene.notes();
    if (record.same) {
      notes_.push_back(fmt::format("{}: run again it comes out the same", d.plan.name));
      return;
    }
    d.record = std::move(record);
    folder_ = folder;
  }

  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  [[nodiscard]] bool time_is_over() const { return o_.rounds == 0 && seconds() >= 60 * o_.minutes; }

  /// The next run, and its place; nothing once no more are wanted.
  std::optional<std::pair<int, PlannedRun>> next() {
    const std::lock_guard lock(mutex_);
    if (stopped_ || first_ != kNone || time_is_over()) return std::nullopt;
    if (at_ == round_.size()) {
      if (o_.rounds != 0 && rounds_ == o_.rounds) return std::nullopt;
      round_ = plan_round(configs_, rounds_++, o_.seed, more_);
      at_ = 0;
    }
    return std::pair(given_++, round_[at_++]);
  }

  void work() {
    try {
      while (auto job = next()) run_one(job->first, std::move(job->second));
    } catch (const Interrupted&) {
      const std::lock_guard lock(mutex_);
      interrupted_ = stopped_ = true;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stopped_ = true;
    }
    const std::lock_guard lock(mutex_);
    seconds_ = seconds();
    ++ended_threads_;
    changed_.notify_all();
  }

  void run_one(int index, PlannedRun plan) {
    ParsedRun run(std::move(plan));
    run.command.out.clear();
    run.command.no_report = run.command.no_divergence = run.command.silent = true;
    run.command.threads = 1;  // of this run; the others have the processors
    run.command.enough = [this, index] { return time_is_over() || index > first_; };
    SceneRun scene(run.command, 0);
    scene.prepare(1);
    scene.run(0);
    TempFiles none;
    report::SceneRecord record = scene.finish(none);
    record.scene = run.plan.name;
    record.each.clear();  // too many to tell
    record.frame_seconds.clear();
    const std::lock_guard lock(mutex_);
    frames_ += static_cast<std::uint64_t>(record.frames);
    if (!record.same && index < first_) first_ = index;
    done_.emplace(index, Done{std::move(run.plan), std::move(record)});
  }

  const RegressCommand& o_;
  std::vector<NamedConfig> configs_;
  std::vector<std::string> more_;
  Clock::time_point start_;
  Progress progress_;
  double build_seconds_ = 0;
  double seconds_ = 0;
  std::vector<std::string> notes_;
  std::string folder_;  // of what is different

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<PlannedRun> round_;
  std::size_t at_ = 0;  // in it
  int rounds_ = 0;      // begun
  int given_ = 0;       // runs
  int ended_threads_ = 0;
  std::map<int, Done> done_;
  std::uint64_t frames_ = 0;
  std::atomic<int> first_{kNone};  // the first run that came out different
  bool stopped_ = false;
  bool interrupted_ = false;
  std::exception_ptr error_;
};

/// A case for each run; classname kage.regress.CONFIGURATION.
void write_junit(JUnitWriter& junit, const report::RunRecord& record) {
  for (const report::SceneRecord& r : record.scenes) {
    junit.group(r.config_name);
    const double seconds = r.golden_seconds + r.rtl_seconds;
    if (r.first_difference)
      junit_difference(junit, r.scene, seconds, *r.first_difference, r.again);
    else
      junit.pass(r.scene, seconds);
  }
  junit.close();
}

/// What each configuration had.
void print_configurations(const report::RunRecord& record) {
  struct Sum {
    std::uint64_t runs = 0;
    std::uint64_t frames = 0;
    bool same = true;
  };
  std::vector<std::string> order;
  std::map<std::string, Sum> sums;
  for (const report::SceneRecord& r : record.scenes) {
    if (sums.count(r.config_name) == 0) order.push_back(r.config_name);
    Sum& s = sums[r.config_name];
    ++s.runs;
    s.frames += static_cast<std::uint64_t>(r.frames);
    s.same = s.same && r.same;
  }
  for (const std::string& name : order) {
    const Sum& s = sums[name];
    fmt::print("  {:<16} {:<12} {:<14} {}\n", name, counted(s.runs, "run"), counted(s.frames, "frame"),
               s.same ? "same" : "different");
  }
}

void print_summary(const report::RunRecord& record) {
  const report::TotalsRecord totals = record.totals();
  const report::RegressRecord& r = *record.regress;
  fmt::print("{}: {}{} of {}, {}, {} compared, {}, {:.0f} s, seed {}\n", totals.same ? "same" : "different",
             r.interrupted ? "interrupted after " : "", counted(record.scenes.size(), "run"),
             counted(r.rounds, "round"), counted(totals.frames, "frame"), counted(totals.pixels_compared, "pixel"),
             counted(totals.cycles, "cycle"), r.seconds, r.seed);
}

int run(const RegressCommand& o) {
  if (o.list) {
    Regress(o).list(std::max(1, o.rounds));
    return kSame;
  }
  const OutFolder folder(o.out);
  const ReportLock lock(o.out);
  check_json(o);
  const std::string page = (std::filesystem::path(o.out) / "report.html").string();
  refuse_twice({o.json == "-" ? "" : o.json, o.ci.junit, page});
  Regress regress(o);
  regress.prepare();
  regress.run(o.jobs > 0 ? o.jobs : default_jobs());
  TempFiles files;
  JUnitWriter junit(files, o.ci.junit, "kage regress");
  regress.look_into(files);
  report::RunRecord record = regress.record();
  write_joined_page(files, page, record, !regress.interrupted());
  record.page = page;
  write_junit(junit, record);
  write_json(o, record, files);
  std::FILE* const to = json_only(o) ? stderr : stdout;
  for (const std::string& note : regress.notes()) fmt::print(to, "{}\n", note);
  if (!json_only(o)) {
    print_summary(record);
    print_configurations(record);
    if (!regress.same()) {
      const report::SceneRecord& d = regress.different();
      print_report(d, d.scene + ": ", regress.folder());
      fmt::print("that run again: {}\n", d.again);
    }
    fmt::print("report over all runs: {}\n", page);
  }
  if (!regress.same()) annotate_difference(o.ci.annotate, regress.different(), to);
  if (!regress.same()) return kDifferent;
  return regress.interrupted() ? interrupted_code() : kSame;
}

}  // namespace

void add_regress(CLI::App& app, Action& action) {
  CLI::App* c = add_command(
      app, "regress", "Run scenes and random frames through all configurations until the time is over",
      "  kage regress\n"
      "  kage regress --minutes 30 --seed 7 --junit regress.xml\n"
      "  kage regress --config glass --config mine.yaml --minutes 1\n"
      "  kage regress --rounds 2 --json -\n"
      "  kage regress --list --config glass\n"
      "Each run is a kage cosim: sound, damaged and mixed random frames and the built-in scenes, in every\n"
      "configuration, with ports that stop and ports that do not (docs/regress.md). The first\n"
      "difference ends the regression: its run is repeated with pictures, waveform, page and the stage that differs\n"
      "first, in DIR/RUN, and the line of kage cosim that repeats it is printed.\n"
      "DIR/report.html is over all runs. The RTL models that are missing are built before the time begins.\n"
      "Exit code 0: the same. 1: different. 2: trouble. A signal ends it with what was done, and the code is 130\n"
      "(Ctrl-C), 143 (SIGTERM) or 129 (SIGHUP), if no difference was found before.");
  const auto o = std::make_shared<RegressCommand>();
  o->out = "out";
  auto* const minutes =
      c->add_option("--minutes", o->minutes, "time to run, default 5; the runs that are under way then end early")
          ->check(real_number(0.01, 10000))
          ->type_name("M");
  c->add_option("--rounds", o->rounds, "so many rounds in place of a time: what is run is the same on every machine")
      ->check(whole_number(1, 1000000))
      ->excludes(minutes)
      ->type_name("N");
  c->add_flag("--list", o->list, "run nothing, but print the runs of the first round, or of --rounds N, as commands");
  c->add_option("--config", o->configs,
                "a configuration, by name or file; may be given several times. Default: all named ones")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NAME|FILE");
  option_seed(*c, *o);
  c->add_option("--out", o->out, "folder for report.html and what is found out about a difference, default out")
      ->type_name("DIR");
  option_json(*c, *o);
  option_junit(*c, o->ci.junit, "run");
  option_annotate(*c, o->ci.annotate);
  c->add_option("--jobs", o->jobs,
                "runs at a time; default one per processor, within half of the memory at 256 MiB a job")
      ->check(whole_number(1, 4096))
      ->type_name("N");
  c->add_flag("--no-divergence", o->no_divergence, "after a difference do not look for the stage that differs first");
  option_fault(*c, o->rtl.fault);
  c->add_option("--mutant", o->rtl.options.mutant)->check(whole_number(1, 100000))->type_name("N")->group("");
  o->command = c;
  c->callback([o, &action] { action = [o] { return run(*o); }; });
}

}  // namespace kage::cli
