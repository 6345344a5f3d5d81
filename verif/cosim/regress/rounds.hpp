// SPDX-License-Identifier: Apache-2.0
//
// The runs of a regression: one co-simulation after another, in rounds (docs/regress.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kage/config.hpp"
#include "kage/cosim.hpp"

namespace kage::cosim {

/// A run of the regression: what it is called, and the co-simulation that it is.
struct RoundRun {
  std::string name;    ///< "damaged.glass.3": the source, the configuration, the round
  std::string config;  ///< the configuration, by its name or file as it was given
  int round = 0;
  CosimOptions options;  ///< with one job and the command lines that repeat it, without a folder
};

/// How the runs are made, for all of them alike.
struct RegressRun {
  std::uint64_t seed = 1;
  RtlRun rtl;                  ///< stalls aside, which runs have of their own
  std::optional<Level> level;  ///< of all frames; nothing: that which the configuration takes
};

/// The runs of round 0, 1, ...: for each configuration sound random frames, sound and damaged ones mixed, damaged ones,
/// and one of the built-in scenes. So each scene has met each configuration after as many rounds as there are scenes.
/// Ports stop in other patterns from round to round, and random frames are others. A configuration with a front end
/// gets polygons, unless `how` says which level is run. Throws Error if two configurations have one name.
std::vector<RoundRun> runs_of_round(const std::vector<NamedConfig>& configs, int round, const RegressRun& how);

}  // namespace kage::cosim
