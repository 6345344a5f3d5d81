// SPDX-License-Identifier: Apache-2.0
//
// The clock that a core reaches on a device, placed and routed by tools/fpga. A core takes minutes, so clocks are kept.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kage/config.hpp"

namespace kage::explore {

/// Result of placing a core.
struct Placement {
  std::optional<double> mhz;  ///< the clock of one placement, by seed 1; none: the core is not placed
  std::string not_placed;     ///< why, as nextpnr says it; empty with a clock
};

/// Places cores on a device, one after another, each once. For several threads.
class Placer {
 public:
  /// `wait` is called several times a second while a tool runs; what it throws ends the tool and goes through. Throws
  /// Error, in one line, if there is no such device, if tools are missing, or if kage's data lack tools/fpga, as those
  /// of an installed kage do.
  Placer(std::string device, std::function<void()> wait);

  [[nodiscard]] const std::string& device() const { return device_; }
  /// Names and versions of the tools, a line each. They decide a clock besides core and device.
  [[nodiscard]] const std::string& versions() const { return versions_; }

  /// Says which cores are going to be placed. Returns how many are not kept, each counted once.
  std::size_t expect(const std::vector<Config>& cores);

  /// Places a core, or takes what is kept. Threads wait for one another. `progress` is told, several times a second,
  /// how far this core and the expected ones are. Clocks are kept in ${XDG_CACHE_HOME:-~/.cache}/kage/placed, keyed by
  /// device, RTL, parameters, what tools/fpga does, and versions(). Throws Error if a tool fails in another way than by
  /// finding no place or no wires for the core.
  Placement place(const Config& config, const std::function<void(const std::string&)>& progress);

 private:
  [[nodiscard]] std::string how_far(double seconds) const;

  std::string device_;
  std::function<void()> wait_;
  std::string versions_;
  std::mutex mutex_;
  std::size_t expected_ = 0;
  std::size_t placed_ = 0;
  double seconds_ = 0;  // that those took
};

}  // namespace kage::explore
