// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace kage::cosim {

/// A model that is kept.
struct CachedModel {
  std::string key;                                 ///< 64 hexadecimal digits
  std::uint64_t bytes = 0;                         ///< of all its files
  std::filesystem::file_time_type last_used = {};  ///< when a program last asked for it
  nlohmann::ordered_json about = {};               ///< what keep() was given; null if that cannot be read
};

/// Limits of the models that prune() leaves: younger than `age`, together smaller than `bytes`. No value: no limit.
struct CacheLimits {
  std::optional<std::chrono::seconds> age = {};  ///< since the last use
  std::optional<std::uint64_t> bytes = {};       ///< of all models; those least recently used go first
};

/// The RTL models that are kept in ${XDG_CACHE_HOME:-~/.cache}/kage/models: KEY.so, and beside it KEY.json with its
/// length, its CRC-32 and what it is of. A model counts only if both fit, so that one that was cut or damaged is never
/// loaded.
class ModelCache {
 public:
  /// Makes the folder if it is missing. Throws Error if it cannot be made, or if somebody else could put models there
  /// (cosim/model/trust.hpp).
  ModelCache();

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path library(const std::string& key) const { return folder_ / (key + ".so"); }
  [[nodiscard]] std::filesystem::path log(const std::string& key) const { return folder_ / (key + ".log"); }
  [[nodiscard]] std::filesystem::path lock(const std::string& key) const { return folder_ / (key + ".lock"); }

  /// Why a kept model is damaged; empty if it is whole. No value if there is none. Throws Error if somebody else could
  /// have changed it.
  [[nodiscard]] std::optional<std::string> damage(const std::string& key) const;

  /// Notes that the model is used.
  void use(const std::string& key) const;

  /// Gives the finished library `built` its place. Both files are on the disk before they get their names. Throws
  /// Error.
  void keep(const std::string& key, const std::filesystem::path& built, const nlohmann::ordered_json& about) const;

  /// All models, the most recently used first.
  [[nodiscard]] std::vector<CachedModel> list() const;

  /// Removes one; false if another program is building it just now.
  [[nodiscard]] bool remove(const std::string& key) const;

  /// Bytes of what belongs to no model: logs of builds that failed, locks, and objects that models are linked with.
  [[nodiscard]] std::uint64_t other_bytes() const;

  /// Removes those other files that are as old as `limits` says or, where the models leave no room, all of them. Files
  /// that are needed are made again.
  void prune_others(const CacheLimits& limits) const;

  /// Removes what is beyond the limits; returns it.
  [[nodiscard]] std::vector<CachedModel> prune(const CacheLimits& limits) const;

 private:
  [[nodiscard]] std::vector<std::filesystem::path> others() const;
  [[nodiscard]] std::filesystem::path manifest(const std::string& key) const { return folder_ / (key + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace kage::cosim
