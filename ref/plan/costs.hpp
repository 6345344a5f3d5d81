// SPDX-License-Identifier: Apache-2.0
//
// Costs of the frames of scenes for a core of given widths, in every arrangement that it may have.
#pragma once

#include <span>
#include <vector>

#include "kage/plan.hpp"
#include "plan/demand.hpp"

namespace kage::plan {

/// Every arrangement of the widths of `base`: banked with each number of lanes and each width of the port. For lines of
/// up to 64 pixels, where a processor for each pixel is still worth it, systolic too.
std::vector<Config> arrangements_of(const Config& base);

/// Makes the frames once and costs them for each of arrangements_of(base), in that order. The golden core runs once.
/// With a front end clocks are those of the core behind it, for frames at the polygon level; words stay those of the
/// span level.
std::vector<PlanCandidate> costs_of(std::span<const PlannedScene> scenes, const Config& base, const std::string& way,
                                    bool front_end, const FrameStep& step);

/// Cells and RAM of a core, in its cost.
void estimate_cells(PlanCost& cost, const Config& config);

}  // namespace kage::plan
