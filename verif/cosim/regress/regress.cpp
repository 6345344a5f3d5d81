// SPDX-License-Identifier: Apache-2.0
#include "cosim/regress/regress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cosim/session/command_lines.hpp"
#include "cosim/session/option_names.hpp"
#include "cosim/session/scene_run.hpp"
#include "cosim/session/workers.hpp"
#include "kage/error.hpp"
#include "number/counted.hpp"

namespace kage::cosim {

Regress::Regress(const RegressOptions& o, Host& host, Cores& cores)
    : o_(o), host_(host), cores_(cores), start_(Clock::now()), progress_(host.progress()) {
  if (o_.configs.empty()) configs_ = named_configs();
  for (const std::string& name : o_.configs) configs_.push_back(load_config(name));
}

std::vector<RoundRun> Regress::list(int rounds) const {
  std::vector<RoundRun> all;
  for (int round = 0; round < rounds; ++round)
    for (RoundRun& run : runs_of_round(configs_, round, o_)) all.push_back(std::move(run));
  return all;
}

void Regress::prepare() {
  (void)runs_of_round(configs_, 0, o_);
  for (NamedConfig c : configs_) {
    host_.check();
    (void)give_front_end(o_.level.value_or(Level::spans), c.config);
    build_seconds_ += cores_.model(c, o_.rtl, host_).build_seconds;
  }
  start_ = Clock::now();
}

void Regress::run() {
  {
    const Workers workers(o_.jobs > 0 ? o_.jobs : default_jobs(), [this] { work(); });
    if (workers.count() == 0) work();
    std::unique_lock lock(mutex_);
    while (ended_threads_ < workers.count()) {
      changed_.wait_for(lock, std::chrono::milliseconds(100));
      progress_->show(
          fmt::format("{}, {}, {:.0f} s", counted(done_.size(), "run"), counted(frames_, "frame"), seconds()));
    }
  }
  progress_->clear();
  // Runs behind the first difference or trouble are not told: how many there are depends on the threads.
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
    note(fmt::format("{} was not repeated: {}", done_.at(first_).run.name, e.what()));
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
  all.regress = {.again = o_.again,
                 .rounds = done_.rbegin()->second.run.round + 1,  // of the runs that are told
                 .seed = o_.seed,
                 .seconds = seconds_,
                 .build_seconds = build_seconds_,
                 .interrupted = interrupted_,
                 .trouble = trouble_ ? std::optional(trouble_->text) : std::nullopt};
  return all;
}

void Regress::repeat(TempFiles& files) {
  Done& d = done_.at(first_);
  const std::filesystem::path folder = std::filesystem::path(o_.out) / d.run.name;
  CosimOptions again = d.run.options;
  again.out = again_folder(folder);
  again.lines = command_lines(again);
  again.out = folder.string();
  again.no_divergence = o_.no_divergence;
  SceneRun scene(again, host_, cores_, 0);
  scene.prepare(1);
  scene.run(0);
  report::SceneRecord record = scene.finish(files);
  record.scene = d.run.name;
  notes_ = scene.notes();
  interrupted_ = interrupted_ || scene.interrupted();
  if (record.same) {
    notes_.push_back(fmt::format("{}: run again it comes out the same", d.run.name));
    return;
  }
  d.record = std::move(record);
  folder_ = folder.string();
}

std::optional<std::pair<int, RoundRun>> Regress::next() {
  const std::lock_guard lock(mutex_);
  if (stopped_ || end_ != kNone || time_is_over()) return std::nullopt;
  if (at_ == round_.size()) {
    if (o_.rounds != 0 && rounds_ == o_.rounds) return std::nullopt;
    round_ = runs_of_round(configs_, rounds_++, o_);
    at_ = 0;
  }
  return std::pair(given_++, round_[at_++]);
}

void Regress::work() {
  try {
    while (auto job = next()) {
      const auto& [place, run] = *job;
      try {
        run_one(place, run);
      } catch (const std::exception& e) {
        end_by({place, run.name, run.config, fmt::format("{} (configuration {}): {}", run.name, run.config, e.what())});
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

void Regress::run_one(int index, RoundRun run) {
  CosimOptions o = run.options;
  o.no_report = o.no_divergence = o.silent = true;
  o.threads = 1;  // of this run; the others have the processors
  o.enough = [this, index] { return time_is_over() || index > end_; };
  SceneRun scene(o, host_, cores_, 0);
  scene.prepare(1);
  scene.run(0);
  TempFiles none;
  report::SceneRecord record = scene.finish(none);
  record.scene = run.name;
  record.each.clear();  // too many to tell
  record.frame_seconds.clear();
  const std::lock_guard lock(mutex_);
  frames_ += static_cast<std::uint64_t>(record.frames);
  if (!record.same) {
    first_ = std::min(first_, index);
    end_ = std::min(end_.load(), index);
  }
  done_.emplace(index, Done{std::move(run), std::move(record)});
}

}  // namespace kage::cosim
