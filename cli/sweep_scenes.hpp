// SPDX-License-Identifier: Apache-2.0
//
// What a sweep is asked for, and the scenes that it measures, with their points.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ci.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "trade/placement.hpp"
#include "trade/sweep_plan.hpp"
#include "trade/sweep_run.hpp"
#include "trade/sweep_scene.hpp"

namespace kage::cli {

struct SweepCommand : Options {
  std::vector<std::string> inputs;
  std::vector<std::string> axes;
  bool grid = false;
  int seeds = 1;
  std::string store = "sweep.sqlite";
  bool resume = false;
  std::vector<std::string> take;
  std::string csv;
  cosim::Shard shard;
  int jobs = 0;
  bool no_area = false;
  bool no_cosim = false;
  bool no_flip = false;
  std::string place;  // a device; what CLI11 gives a flag: the one of the counts
  bool list = false;
  std::string again;  ///< the command line that makes the same page of the store
};

/// Runs at a time.
int jobs_of(const SweepCommand& o);

/// The tools that measure, asked before anything is measured: one that is missing ends the sweep.
struct Tools {
  trade::SweepTools versions;
  std::unique_ptr<trade::Placer> placer;
};

Tools tools_of(const SweepCommand& o);

/// A scene with its points.
struct SweptScene {
  std::string input;  ///< as the command line has it
  std::vector<trade::SweepPoint> points;
  std::string left_out;  ///< of --grid, in words: how many combinations are none of them, and why
  std::unique_ptr<trade::SweepScene> scene;
  std::unique_ptr<trade::SweepRunner> runner;
};

/// Whether some light of a scene is soft, so that samples and their seeds change pictures.
bool is_soft(const SweptScene& s);

/// Opens a scene of the command line. `doing` is told, by several threads, what takes long while its points are
/// measured.
SweptScene open_swept(const SweepCommand& o, const Tools& tools, const std::string& input, Progress& progress,
                      std::function<void(const std::string&)> doing);

}  // namespace kage::cli
