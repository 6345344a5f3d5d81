// SPDX-License-Identifier: Apache-2.0
//
// What kage cosim and kage merge do for continuous integration: shards of the frames, JUnit cases and annotations of a
// verdict. Both work from the report's JSON, so that a joined report says what its parts said.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "common.hpp"
#include "cosim/run.hpp"
#include "junit.hpp"

namespace kage::cli {

/// Which part of the frames a run has: of N shards, shard I has the frames I - 1, I - 1 + N, I - 1 + 2 N, ... Frames
/// that are dear lie side by side, so shards that take turns have as much to do as one another; and which frames a
/// shard has depends on nothing but I and N.
struct Shard {
  int index = 1;  ///< from 1
  int count = 1;
  bool given = false;

  [[nodiscard]] cosim::FrameSteps steps() const { return {index - 1, count}; }

  /// Of so many frames.
  [[nodiscard]] int frames(int of) const { return of < index ? 0 : (of - index) / count + 1; }
};

struct CiOptions {
  Shard shard;
  std::string junit;
  std::string annotate;  ///< "github", "none", or "": as the environment says
};

void option_shard(CLI::App& command, Shard& shard);
void option_junit(CLI::App& command, std::string& path);
void option_annotate(CLI::App& command, std::string& annotate);

/// Adds to the report of a run what kage merge needs to know of it: "scene", "total_frames", "shard", and "options",
/// what decides the words and clocks besides.
void describe_run(Json& report, const std::string& scene, int total, const Shard& shard, Json options);

/// A case for each frame of the reports, which are those of all shards in order, or of a single run. Frames behind a
/// difference were not compared and are skipped.
void junit_frames(JUnitWriter& junit, const std::vector<const Json*>& shards);

/// If `annotate` or, where that is empty, the environment ($GITHUB_ACTIONS) asks for it: a line on `to` by which GitHub
/// shows the first difference at the RTL file whose stage made it.
void annotate_difference(const std::string& annotate, const Json& report, std::FILE* to);

}  // namespace kage::cli
