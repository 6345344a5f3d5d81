// SPDX-License-Identifier: Apache-2.0
//
// What kage cosim and kage merge do for continuous integration: shards of the frames, JUnit cases and annotations of a
// verdict. Both work from the run's record, so that a joined one says what its parts said.
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

/// --shard; `what` is its help: what of the command the Ith of N parts is.
void option_shard(CLI::App& command, Shard& shard,
                  const std::string& what =
                      "run the Ith of N parts of the frames of all scenes: frame I - 1 and every "
                      "Nth after it. kage merge joins the reports");
void option_junit(CLI::App& command, std::string& path, const std::string& each = "frame");
void option_annotate(CLI::App& command, std::string& annotate);

/// A case for each frame of a scene's records, which are those of all shards, or of a single run. Frames behind a
/// difference were not compared and are skipped.
void junit_frames(JUnitWriter& junit, const std::vector<const report::SceneRecord*>& shards);

/// A failed case: a scene's first difference with the first divergence, and the RTL file to blame. `again` is the
/// command that repeats it, if it is to be told.
void junit_difference(JUnitWriter& junit, const std::string& name, double seconds,
                      const report::DifferenceRecord& difference, const std::string& again = "");

/// If `annotate` or, where that is empty, the environment ($GITHUB_ACTIONS) asks for it: a line on `to` by which GitHub
/// shows the first difference at the RTL file whose stage made it.
void annotate_difference(const std::string& annotate, const report::SceneRecord& scene, std::FILE* to);

}  // namespace kage::cli
