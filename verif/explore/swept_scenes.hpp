// SPDX-License-Identifier: Apache-2.0
//
// The options of a sweep, and the scenes that it measures, with their points.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "explore/placement.hpp"
#include "explore/sweep_points.hpp"
#include "explore/sweep_run.hpp"
#include "explore/sweep_scene.hpp"
#include "kage/cosim.hpp"

namespace kage::explore {

/// The options of a sweep. Members without a word of their own are the options of `kage sweep` of their names.
struct SweepOptions : cosim::SourceOptions {
  std::vector<std::string> inputs;
  std::vector<std::string> axes;
  bool grid = false;
  int seeds = 1;
  std::string store = "sweep.sqlite";
  int jobs = 0;
  bool no_area = false;
  bool no_cosim = false;
  bool no_flip = false;
  std::string place;  ///< a device; empty: no core is placed
  bool list = false;  ///< nothing is measured: tools are not asked for
  std::string build;  ///< which kage measures: rows of another are not taken
};

/// Runs at a time.
int jobs_of(const SweepOptions& o);

/// The tools that measure, asked before anything is measured: one that is missing ends the sweep.
struct Tools {
  SweepTools versions;
  std::unique_ptr<Placer> placer;
};

Tools tools_of(const SweepOptions& o, cosim::Host& host);

/// A scene with its points.
struct SweptScene {
  std::string input;  ///< as the command line has it
  std::vector<SweepPoint> points;
  std::string left_out;  ///< of --grid, in words: how many combinations are none of them, and why
  std::unique_ptr<SweepScene> scene;
  std::unique_ptr<SweepRunner> runner;
};

/// Whether some light of a scene is soft, so that samples and their seeds change pictures.
bool is_soft(const SweptScene& s);

/// Opens a scene of the command line. `doing` is told, by several threads, what takes long while its points are
/// measured.
SweptScene open_swept(const SweepOptions& o, const Tools& tools, const std::string& input, cosim::Host& host,
                      cosim::Progress& progress, std::function<void(const std::string&)> doing);

}  // namespace kage::explore
