// SPDX-License-Identifier: Apache-2.0
//
// The results of sweeps in one SQLite file, each there as soon as it is known (docs/sweep.md, "The store").
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "trade/sweep_run.hpp"

namespace kage::trade {

/// For several threads, and several programs, at once. All functions throw Error that names the file.
class SweepStore {
 public:
  /// The version of the schema below.
  static constexpr int kVersion = 1;

  /// Opens a store, or makes one. Throws Error if the file is no store, or one of another version, or damaged; then it
  /// is left as it is.
  explicit SweepStore(const std::filesystem::path& file);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  /// A run's row, JSON as it was kept.
  [[nodiscard]] std::optional<std::string> run(const std::string& key);
  /// Keeps a run in a transaction of its own: it is there whole, or not at all, whatever happens next.
  void keep_run(const std::string& key, const std::string& scene, const std::string& point, const std::string& row);
  [[nodiscard]] std::optional<ClockSample> clocks(const std::string& key);
  void keep_clocks(const std::string& key, const ClockSample& sample);

  /// Takes all rows of another store that are not here. Returns how many runs those were.
  int absorb(const std::filesystem::path& other);
  [[nodiscard]] int runs();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage::trade
