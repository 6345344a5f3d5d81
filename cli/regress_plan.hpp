// SPDX-License-Identifier: Apache-2.0
//
// What kage regress runs: one `kage cosim` after another, in rounds (docs/regress.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kage/config.hpp"

namespace kage::cli {

/// The option of kage cosim that says who makes spans of polygons.
inline constexpr const char* kFrontEnd = "--front-end";

/// A run of the regression: what it is called, and the command line of kage cosim that it stands for.
struct PlannedRun {
  std::string name;    ///< "damaged.glass.3": the source, the configuration, the round
  std::string config;  ///< the configuration, by its name or file as it was given
  int round = 0;
  std::vector<std::string> arguments;  ///< of kage cosim, --jobs 1 among them, without --out
};

/// The runs of round 0, 1, ...: for each configuration sound random frames, sound and damaged ones mixed, damaged ones,
/// and one of the built-in scenes, so that each scene has met each configuration after as many rounds as there are
/// scenes. Ports stop in other patterns from round to round, and random frames are others. A configuration with a front
/// end gets polygons (--front-end rtl), unless `more` says who makes spans. Every run has the options of `more`
/// besides. Throws Error if two configurations have one name.
std::vector<PlannedRun> plan_round(const std::vector<NamedConfig>& configs, int round, std::uint64_t seed,
                                   const std::vector<std::string>& more);

}  // namespace kage::cli
