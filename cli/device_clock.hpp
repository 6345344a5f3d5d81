// SPDX-License-Identifier: Apache-2.0
//
// The clock that cores reached on a device, as constraints/figures.json recorded it (docs/timing.md).
#pragma once

#include <string>

namespace kage::cli {

struct DeviceClock {
  double mhz = 0;
  std::string core;  ///< the slowest core with lanes of those that were placed there
};

/// The clock of the slowest core on the device: a plan does not know its own until it is placed. Throws Error if the
/// device has no row.
/// @param front_end whether the core may have a front end: cores with one are slower
DeviceClock device_clock(const std::string& device, bool front_end);

}  // namespace kage::cli
