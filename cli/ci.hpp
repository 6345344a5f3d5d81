// SPDX-License-Identifier: Apache-2.0
//
// What kage cosim and kage merge do for continuous integration: shards of the frames, JUnit cases and annotations of a
// verdict, several scenes as one. Both work from the report's JSON, so that a joined report says what its parts said.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "cosim/run.hpp"
#include "junit.hpp"
#include "options.hpp"
#include "results.hpp"

namespace kage::cli {

/// Which part of the frames a run has. The frames of all its scenes, in the order given, are one list; of N shards,
/// shard I has the entries I - 1, I - 1 + N, I - 1 + 2 N, ... Frames that are dear lie side by side, so shards that
/// take turns have as much to do as one another; and which frames a shard has depends on nothing but I, N and the list.
struct Shard {
  int index = 1;  ///< from 1
  int count = 1;
  bool given = false;

  /// Of a scene before which others have so many frames.
  [[nodiscard]] cosim::FrameSteps steps(std::int64_t before = 0) const {
    const std::int64_t first = index - 1 - before % count;
    return {static_cast<int>(first < 0 ? first + count : first), count};
  }

  /// How many of its `of` frames.
  [[nodiscard]] int frames(int of, std::int64_t before = 0) const {
    const int first = steps(before).first;
    return of <= first ? 0 : (of - 1 - first) / count + 1;
  }
};

struct CiOptions {
  Shard shard;
  std::string junit;
  std::string annotate;  ///< "github", "none", or "": as the environment says
};

void option_shard(CLI::App& command, Shard& shard);
void option_junit(CLI::App& command, std::string& path, const std::string& each = "frame");
void option_annotate(CLI::App& command, std::string& annotate);

/// Adds to the report of a run what kage merge needs to know of it: "scene", "total_frames", "first_frame" and
/// "frame_step", which of them it has, "shard", and "options", what decides the words and clocks besides.
void describe_run(Json& report, const std::string& scene, int total, const Shard& shard, cosim::FrameSteps steps,
                  Json options);

/// What stands in for the report of a scene of which a shard has no frame.
Json no_frames(const std::string& scene, int total);

/// Whether a report is such a one.
bool has_frames(const Json& report);

/// "verdicts" of several reports as one: how many frames have their verdicts from earlier runs, how many verdicts are
/// kept for later ones, and what was in the way of that.
Json all_verdicts(const std::vector<const Json*>& parts);

/// The reports of several scenes as one, which has them in "scenes": sums, and the first difference of the first scene
/// that has one, with that scene's name.
Json all_scenes(std::vector<Json> scenes);

/// How many frames of a report have their verdicts from earlier runs.
std::uint64_t taken_of(const Json& report);

/// A case for each frame of a scene's reports, which are those of all shards, or of a single run. Frames behind a
/// difference were not compared and are skipped.
void junit_frames(JUnitWriter& junit, const std::vector<const Json*>& shards);

/// A failed case: a report's first difference with the first divergence, and the RTL file to blame. `again` is the
/// command that repeats it, if it is to be told.
void junit_difference(JUnitWriter& junit, const std::string& name, double seconds, const Json& difference,
                      const std::string& again = "");

/// If `annotate` or, where that is empty, the environment ($GITHUB_ACTIONS) asks for it: a line on `to` by which GitHub
/// shows the first difference at the RTL file whose stage made it.
void annotate_difference(const std::string& annotate, const Json& report, std::FILE* to);

}  // namespace kage::cli
