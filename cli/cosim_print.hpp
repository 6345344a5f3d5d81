// SPDX-License-Identifier: Apache-2.0
//
// Prints a scene's record for kage cosim.
#pragma once

#include <string>

#include "results.hpp"

namespace kage::cli {

/// The first line of a scene: "same: 8 frames, 640x480, ...". `who` begins it.
void print_verdict(const report::SceneRecord& scene, const std::string& who);

/// That line and the first difference, as text alone: the result that stands although no file of the run appears.
void print_finding(const report::SceneRecord& scene, const std::string& who);

/// Coverage: points that the frames reached, and points that none did; `who` begins the line of each group.
void print_coverage(const report::CoverageRecord& coverage, const std::string& who);

/// All of it: verdict, coverage, first difference, the frame that was kept, pictures in `folder`, page.
void print_report(const report::SceneRecord& scene, const std::string& who, const std::string& folder);

}  // namespace kage::cli
