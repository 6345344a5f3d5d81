// SPDX-License-Identifier: Apache-2.0
//
// The reports that kage cosim --shard wrote, read again and held against each other.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cosim/report/run_record.hpp"

namespace kage::report {

/// The report of one shard.
struct ShardFile {
  std::string file;
  RunRecord record;
  ShardNumber number;
};

/// The files in the order of their shards. Throws Error unless all are whole reports of one run's shards, each there
/// once: the same scenes, sizes, configurations, seeds and options, and every frame in just one. `wait`
/// is called before each file; it may throw, which ends it.
std::vector<ShardFile> read_shards(const std::vector<std::string>& files, const std::function<void()>& wait);

/// The records of those that have frames of a scene; there is one.
std::vector<const SceneRecord*> scene_of_shards(const std::vector<ShardFile>& shards, std::size_t scene);

/// The record of the run that read_shards() read all shards of: as one run would have made it, but for what each shard
/// tells of its own frames alone, which stays with it, in SceneRecord::shards.
RunRecord joined_record(const std::vector<ShardFile>& shards);

}  // namespace kage::report
