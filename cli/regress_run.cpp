// SPDX-License-Identifier: Apache-2.0
#include "regress_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "command.hpp"
#include "cosim_run.hpp"
#include "kage/error.hpp"
#include "signals.hpp"
#include "text.hpp"
#include "workers.hpp"

namespace kage::cli {
namespace {

/// A planned run as kage cosim takes it.
struct ParsedRun {
  PlannedRun plan;
  CLI::App app;
  CosimCommand command;
  Action nothing;

  /// `more` follows on its line.
  explicit ParsedRun(PlannedRun p, const std::vector<std::string>& more = {}) : plan(std::move(p)) {
    cosim_command(app, command);
    add_explain(app, nothing);  // the page tells its command lines
    std::vector<std::string> line = plan.arguments;
    line.insert(line.end(), more.begin(), more.end());
    line.insert(line.begin(), "cosim");
    std::reverse(line.begin(), line.end());  // as CLI11 takes it
    app.parse(line);
    command.input = command.inputs.front();
  }
};

}  // namespace

Regress::Regress(const RegressCommand& o) : o_(o), start_(Clock::now()) {
  const std::vector<std::string>& names = o_.configs;
  if (names.empty()) configs_ = named_configs();
  for (const std::string& name : names) configs_.push_back(load_config(name));
  std::vector<const char*> handed_on(kRtlOptions.begin(), kRtlOptions.end());
  handed_on.push_back(kFrontEnd);
  for (const char* name : handed_on)
    if (const CLI::Option* option = o_.command->get_option_no_throw(name); option != nullptr && option->count() != 0)
      more_.insert(more_.end(), {name, option->results().back()});
}

void Regress::list(int rounds) const {
  for (int round = 0; round < rounds; ++round)
    for (const PlannedRun& run : plan_round(configs_, round, o_.seed, more_)) {
      std::string line = run.name + ": kage cosim";
      for (const std::string& argument : run.arguments) line += " " + quoted(argument);
      fmt::print("{}\n", line);
    }
}

void Regress::prepare() {
  (void)plan_round(configs_, 0, o_.seed, more_);
  for (NamedConfig c : configs_) {
    check_interrupt();
    (void)give_front_end(o_, c.config);
    build_seconds_ += model_of(c, o_.rtl).build_seconds;
  }
  start_ = Clock::now();
}

void Regress::run(int jobs) {
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
  // Of runs behind the first difference or trouble nothing is told: how many there are depends on the threads.
  done_.erase(done_.upper_bound(end_), done_.end());
  if (trouble_ && trouble_->place < first_) first_ = kNone;
  if (trouble_ && trouble_->place > first_) trouble_.reset();
}

void Regress::look_into(TempFiles& files) {
  if (first_ == kNone || interrupted_) return;
  try {
    repeat(files);
  } catch (const Interrupted&) {
    interrupt();
  } catch (const std::exception& e) {
    note(fmt::format("{} was not repeated: {}", done_.at(first_).plan.name, e.what()));
  }
}

void Regress::interrupt() {
  interrupted_ = true;
  note("interrupted after the verdict");
}

report::RunRecord Regress::record() const {
  report::RunRecord all;
  all.several = true;
  for (const auto& [index, d] : done_) all.scenes.push_back(d.record);
  if (all.scenes.empty() && trouble_) throw Error(trouble_->text);
  if (all.scenes.empty()) throw Interrupted{};  // nothing else keeps the first run from its end
  all.regress = {.again = command_line(*o_.command),
                 .rounds = done_.rbegin()->second.plan.round + 1,  // of the runs that are told
                 .seed = o_.seed,
                 .seconds = seconds_,
                 .build_seconds = build_seconds_,
                 .interrupted = interrupted_,
                 .trouble = trouble_ ? std::optional(trouble_->text) : std::nullopt};
  return all;
}

void Regress::repeat(TempFiles& files) {
  Done& d = done_.at(first_);
  const std::filesystem::path folder = std::filesystem::path(o_.out) / d.plan.name;
  ParsedRun again(d.plan, {"--out", again_folder(folder)});
  again.command.out = folder.string();
  again.command.no_divergence = o_.no_divergence;
  SceneRun scene(again.command, 0);
  scene.prepare(1);
  scene.run(0);
  report::SceneRecord record = scene.finish(files);
  record.scene = d.plan.name;
  notes_ = scene.notes();
  interrupted_ = interrupted_ || scene.interrupted();
  if (record.same) {
    notes_.push_back(fmt::format("{}: run again it comes out the same", d.plan.name));
    return;
  }
  d.record = std::move(record);
  folder_ = folder.string();
}

std::optional<std::pair<int, PlannedRun>> Regress::next() {
  const std::lock_guard lock(mutex_);
  if (stopped_ || end_ != kNone || time_is_over()) return std::nullopt;
  if (at_ == round_.size()) {
    if (o_.rounds != 0 && rounds_ == o_.rounds) return std::nullopt;
    round_ = plan_round(configs_, rounds_++, o_.seed, more_);
    at_ = 0;
  }
  return std::pair(given_++, round_[at_++]);
}

void Regress::work() {
  try {
    while (auto job = next()) {
      const auto& [place, plan] = *job;
      try {
        run_one(place, plan);
      } catch (const std::exception& e) {
        end_by({place, plan.name, plan.config,
                fmt::format("{} (configuration {}): {}", plan.name, plan.config, e.what())});
      }
    }
  } catch (const Interrupted&) {
    const std::lock_guard lock(mutex_);
    interrupted_ = stopped_ = true;
  }
  const std::lock_guard lock(mutex_);
  seconds_ = seconds();
  ++ended_threads_;
  changed_.notify_all();
}

/// The runs before it go on: one of them may have trouble, or differ.
void Regress::end_by(Trouble trouble) {
  const std::lock_guard lock(mutex_);
  if (trouble_ && trouble_->place < trouble.place) return;
  end_ = std::min(end_.load(), trouble.place);
  trouble_ = std::move(trouble);
}

void Regress::run_one(int index, PlannedRun plan) {
  ParsedRun run(std::move(plan));
  run.command.out.clear();
  run.command.no_report = run.command.no_divergence = run.command.silent = true;
  run.command.threads = 1;  // of this run; the others have the processors
  run.command.enough = [this, index] { return time_is_over() || index > end_; };
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
  if (!record.same) {
    first_ = std::min(first_, index);
    end_ = std::min(end_.load(), index);
  }
  done_.emplace(index, Done{std::move(run.plan), std::move(record)});
}

}  // namespace kage::cli
