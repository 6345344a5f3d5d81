// SPDX-License-Identifier: Apache-2.0
//
// The runs of a regression: one co-simulation after another, on several threads, until the time is over or one comes
// out different.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cosim/regress/rounds.hpp"
#include "cosim/report/run_record.hpp"
#include "cosim/session/cores.hpp"
#include "file/temp_file.hpp"
#include "kage/config.hpp"

namespace kage::cosim {

/// The runs of a regression, and their time.
struct RegressOptions : RegressRun {
  std::vector<std::string> configs;  ///< names and files; none: all named ones
  double minutes = 5;
  int rounds = 0;  ///< instead of a time; 0: as many as the minutes hold
  int jobs = 0;    ///< runs at a time; 0: default_jobs()
  bool no_divergence = false;
  std::string out;    ///< a folder for what is found out about a difference
  std::string again;  ///< the command line that repeats it, for reports
};

class Regress {
 public:
  /// All must outlive it.
  Regress(const RegressOptions& o, Host& host, Cores& cores = rtl_cores());

  /// The runs of the first rounds.
  [[nodiscard]] std::vector<RoundRun> list(int rounds) const;

  /// Builds what models are missing; then the time begins.
  void prepare();

  /// All runs, several at a time. The first difference ends them, and so does the first trouble.
  void run();

  /// A run that came to no verdict.
  struct Trouble {
    int place;  ///< of the run
    std::string name;
    std::string config;
    std::string text;  ///< with the names
  };
  /// The trouble that ended the runs, if one did: all else is then told of the runs before it.
  [[nodiscard]] const std::optional<Trouble>& trouble() const { return trouble_; }

  /// The run that came out different, once more, with all that kage cosim finds out about it; its lines.
  void look_into(TempFiles& files);

  /// After run(): the verdict stands, but a signal ends what is said about it.
  void interrupt();
  void note(std::string text) { notes_.push_back(std::move(text)); }

  [[nodiscard]] bool interrupted() const { return interrupted_; }
  [[nodiscard]] bool same() const { return first_ == kNone; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] const report::SceneRecord& different() const { return done_.at(first_).record; }

  /// The record of all runs. Throws Error where trouble ended the very first one.
  [[nodiscard]] report::RunRecord record() const;

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kNone = std::numeric_limits<int>::max();
  struct Done {
    RoundRun run;
    report::SceneRecord record;
  };

  void repeat(TempFiles& files);
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  [[nodiscard]] bool time_is_over() const { return o_.rounds == 0 && seconds() >= 60 * o_.minutes; }
  /// The next run, and its place; nothing once no more are wanted.
  std::optional<std::pair<int, RoundRun>> next();
  void work();
  void run_one(int index, RoundRun run);
  void end_by(Trouble trouble);

  const RegressOptions& o_;
  Host& host_;
  Cores& cores_;
  std::vector<NamedConfig> configs_;
  Clock::time_point start_;
  std::unique_ptr<Progress> progress_;
  double build_seconds_ = 0;
  double seconds_ = 0;
  std::vector<std::string> notes_;
  std::string folder_;  // of what is different

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<RoundRun> round_;
  std::size_t at_ = 0;  // in it
  int rounds_ = 0;      // begun
  int given_ = 0;       // runs
  int ended_threads_ = 0;
  std::map<int, Done> done_;
  std::uint64_t frames_ = 0;
  int first_ = kNone;  // the first run that came out different
  std::optional<Trouble> trouble_;
  std::atomic<int> end_{kNone};  // the lower place of both: runs behind it are not wanted
  bool stopped_ = false;
  bool interrupted_ = false;
};

}  // namespace kage::cosim
