// SPDX-License-Identifier: Apache-2.0
//
// The results of sweeps in one SQLite file, each there as soon as it is known (docs/sweep.md, "The store").
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "explore/sweep_run.hpp"

namespace kage::explore {

/// Sources of a row, beyond its point: two rows of a point differ in one of these, or in what the sweep was asked.
struct MadeOf {
  std::string build;  ///< build_identity()
  std::string scene;  ///< SweepScene::identity()
  std::string tools;  ///< SweepRunner::tools_text()
};

/// For several threads, and several programs, at once. All functions throw Error that names the file.
class SweepStore {
 public:
  /// The version of the schema below.
  static constexpr int kVersion = 3;

  /// Opens a store, or makes one. Throws Error if the file is no store, or one of another version, or damaged; then it
  /// is left as it is.
  explicit SweepStore(const std::filesystem::path& file);
  ~SweepStore();
  SweepStore(const SweepStore&) = delete;
  SweepStore& operator=(const SweepStore&) = delete;

  /// A run's row, JSON as it was kept. Throws Error that names file and row if it is not what was kept.
  [[nodiscard]] std::optional<std::string> run(const std::string& key);
  /// Keeps a run in a transaction of its own: it is there whole, or not at all, whatever happens next.
  void keep_run(const std::string& key, const std::string& scene, const std::string& point, const MadeOf& of,
                const std::string& row);
  /// If there are rows of a point, and none has these sources: the difference to the row that has most in common with
  /// them. It is "another build of kage", "another scene of this name" or "other tools, or of more or fewer of them".
  /// Empty otherwise.
  [[nodiscard]] std::string old(const std::string& scene, const std::string& point, const MadeOf& of);
  [[nodiscard]] std::optional<ClockSample> clocks(const std::string& key);
  void keep_clocks(const std::string& key, const ClockSample& sample);

  /// Throws Error if a file that is there is no store, or one of another version, or damaged, a row of it
  /// among what may be. It is left as it is.
  static void check(const std::filesystem::path& file);

  /// Whether a file is there and has no bytes: what SQLite makes first, and a sweep that is killed at once leaves.
  static bool is_empty(const std::filesystem::path& file);

  /// Takes all rows of another store that are not here. Returns how many runs those were. Throws Error, and takes none,
  /// if one of the other's is not what was kept.
  int absorb(const std::filesystem::path& other);
  [[nodiscard]] int runs();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace kage::explore
