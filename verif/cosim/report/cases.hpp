// SPDX-License-Identifier: Apache-2.0
//
// A verdict for continuous integration: JUnit's cases, and annotations. Made of the run's record, so that a joined one
// says what its parts said.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "cosim/report/junit.hpp"
#include "cosim/report/run_record.hpp"

namespace kage::report {

/// A case for each frame of a scene's records, which are those of all shards, or of a single run. Frames behind a
/// difference were not compared and are skipped.
void junit_frames(JUnitWriter& junit, const std::vector<const SceneRecord*>& shards);

/// A failed case: a scene's first difference with the first divergence, and the RTL file to blame. `again` is the
/// command that repeats it, if it is to be told.
void junit_difference(JUnitWriter& junit, const std::string& name, double seconds, const DifferenceRecord& difference,
                      const std::string& again = "");

/// If `annotate` or, where that is empty, the environment ($GITHUB_ACTIONS) asks for it: a line on `to` by which GitHub
/// shows the first difference at the RTL file whose stage made it.
void annotate_difference(const std::string& annotate, const SceneRecord& scene, std::FILE* to);

}  // namespace kage::report
