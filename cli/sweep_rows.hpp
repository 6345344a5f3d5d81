// SPDX-License-Identifier: Apache-2.0
//
// The rows of a sweep: made, several at a time, or taken from the store.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "progress.hpp"
#include "results.hpp"
#include "sweep_scenes.hpp"
#include "trade/sweep_store.hpp"

namespace kage::cli {

/// The schema of rows. Raise it when what is measured, or how, changes a row.
inline constexpr const char* kRows = "kage.sweep/1";

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

  void doing(const std::string& what);
  /// A run has ended; `made`: it was not taken from the store.
  void done(bool made);
  void clear();
  [[nodiscard]] std::size_t made() const { return made_; }

 private:
  void show();

  std::mutex mutex_;
  Progress progress_;
  std::size_t runs_;
  std::size_t done_ = 0;
  std::size_t made_ = 0;
  std::string what_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Makes the rows of the list, several at a time, or takes them from the store.
class Sweep {
 public:
  Sweep(const SweepCommand& o, const Tools& tools, std::vector<SweptScene>& scenes, trade::SweepStore& store,
        Told& told);

  /// Says how many rows the store has of another build, scene or tool alone, which are of no use now.
  void announce_old(const std::vector<Entry>& entries);
  /// Gives each entry its row.
  void run(std::vector<Entry>& entries);

 private:
  /// All that decides the clocks of a point, but for the model, which is of the same build.
  [[nodiscard]] std::string clocks_key(const SweptScene& s, std::size_t point) const;
  [[nodiscard]] std::string row_key(const SweptScene& s, std::size_t point, const trade::PointWords& words) const;
  /// What a row is made of, as a person tells one from another.
  [[nodiscard]] trade::MadeOf made_of(const SweptScene& s, std::size_t point) const;
  void make(Entry& e);

  const SweepCommand& o_;
  std::vector<SweptScene>& scenes_;
  trade::SweepStore& store_;
  Told& told_;
  std::string build_;
  std::string model_tools_;
};

}  // namespace kage::cli
