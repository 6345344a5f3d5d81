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
  report::RunRecord record;
  report::ShardNumber number;
};

/// The files in the order of their shards. Throws Error unless all are whole reports of one run's shards, each there
/// once: the same scenes, sizes, configurations, seeds and options, and every frame in just one.
std::vector<ShardFile> read_shards(const std::vector<std::string>& files);

}  // namespace kage::cli
