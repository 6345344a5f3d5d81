// SPDX-License-Identifier: Apache-2.0
//
// The rows of a sweep: made, several at a time, or taken from the store.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "cosim/report/run_record.hpp"
#include "explore/sweep_store.hpp"
#include "explore/swept_scenes.hpp"

namespace kage::explore {

/// The schema of rows. Raise it when what is measured, or how, changes a row.
inline constexpr const char* kRows = "kage.sweep/1";

/// A run of the list.
struct Entry {
  std::size_t scene = 0;
  std::size_t point = 0;
  report::Json row;
};

/// How far it has come, told by several threads: first the cores of the runs are made, then the runs.
class Told {
 public:
  explicit Told(cosim::Host& host) : progress_(host.progress()) {}

  /// A stage of so many steps begins, "run" and "runs".
  void begin(std::size_t steps, const std::string& one, const std::string& more);
  void doing(const std::string& what);
  /// A step has ended; `made`: it took work, and was not taken from the store.
  void done(bool made);
  void clear();

 private:
  void show();

  std::mutex mutex_;
  std::unique_ptr<cosim::Progress> progress_;
  std::string steps_name_;
  std::size_t steps_ = 0;
  std::size_t done_ = 0;
  std::size_t made_ = 0;
  std::string what_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Makes the rows of the list, several at a time, or takes them from the store.
class Sweep {
 public:
  /// All must outlive it.
  Sweep(const SweepOptions& o, const Tools& tools, std::vector<SweptScene>& scenes, SweepStore& store, Told& told,
        cosim::Host& host);

  /// Says how many rows the store has of another build, scene or tool alone, which are of no use now.
  void announce_old(const std::vector<Entry>& entries);
  /// Gives each entry its row.
  void run(std::vector<Entry>& entries);
  /// Rows that were measured, and not taken from the store.
  [[nodiscard]] std::size_t measured() const { return measured_; }

 private:
  /// All that decides the clocks of a point, but for the model, which is of the same build.
  [[nodiscard]] std::string clocks_key(const SweptScene& s, std::size_t point) const;
  [[nodiscard]] std::string row_key(const SweptScene& s, std::size_t point, const PointWords& words) const;
  /// The ingredients of a row, as a person tells one from another.
  [[nodiscard]] MadeOf made_of(const SweptScene& s, std::size_t point) const;
  /// The row that the store has for an entry; its key, and its words where they are wanted.
  struct Place {
    PointWords words;
    std::string key;
    std::optional<std::string> kept;
  };
  Place place_of(const Entry& e);
  /// Gives an entry the row that the store has, if it has one.
  bool take_kept(Entry& e, const Place& place) const;
  /// Has the core of an entry's row made, unless the store has the row.
  void prepare(Entry& e);
  void make(Entry& e);
  /// Calls `work` for each entry, several at a time. The first error ends it and is thrown.
  void each(std::vector<Entry>& entries, const std::function<void(Entry&)>& work) const;

  const SweepOptions& o_;
  std::vector<SweptScene>& scenes_;
  SweepStore& store_;
  Told& told_;
  cosim::Host& host_;
  std::atomic<std::size_t> measured_{0};
  std::string build_;
  std::string model_tools_;
};

}  // namespace kage::explore
