// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cosim/model/lock.hpp"

namespace kage::report {

/// While one lives, no other run writes its report into the folder. Throws Error if one does now.
class ReportLock {
 public:
  explicit ReportLock(const std::string& folder);

 private:
  cosim::Lock lock_;
};

}  // namespace kage::report
