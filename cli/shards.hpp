// SPDX-License-Identifier: Apache-2.0
//
// The reports that kage cosim --shard wrote, read again and held against each other.
#pragma once

#include <string>
#include <vector>

#include "results.hpp"

namespace kage::cli {

/// What one shard reported.
struct ShardFile {
  std::string file;
  Json report;
  int index = 0;  ///< from 1
  int count = 1;

  /// Of its scenes, in order: a report of a single scene is its own.
  [[nodiscard]] std::size_t scenes() const { return report.contains("scenes") ? report["scenes"].size() : 1; }
  [[nodiscard]] const Json& scene(std::size_t i) const {
    return report.contains("scenes") ? report["scenes"][i] : report;
  }
};

/// The files in the order of their shards. Throws Error unless all are whole reports of one run's shards, each there
/// once: the same scenes, sizes, configurations, seeds and options, and every frame in just one.
std::vector<ShardFile> read_shards(const std::vector<std::string>& files);

}  // namespace kage::cli
