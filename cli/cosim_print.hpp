// SPDX-License-Identifier: Apache-2.0
//
// What kage cosim prints of a report, and who else may write one meanwhile.
#pragma once

#include <string>

#include "cosim/model/lock.hpp"
#include "results.hpp"

namespace kage::cli {

/// While one lives, no other run writes its report into the folder. Throws Error if one does now.
class ReportLock {
 public:
  explicit ReportLock(const std::string& folder);

 private:
  cosim::Lock lock_;
};

/// The first line of a report: "same: 8 frames, 640x480, ...". `who` begins it.
void print_verdict(const Json& report, const std::string& who);

/// All of it: verdict, coverage, first difference, the frame that was kept, pictures in `folder`, page.
void print_report(const Json& report, const std::string& who, const std::string& folder);

}  // namespace kage::cli
