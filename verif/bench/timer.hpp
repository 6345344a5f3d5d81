// SPDX-License-Identifier: Apache-2.0
// Wall time.
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

namespace kage::bench {

/// Runs from its making on; a new one begins anew.
class Timer {
 public:
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Least time of a few runs of `work`, in seconds.
template <class Work>
double least_seconds(int runs, Work work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const Timer timer;
    work();
    best = std::min(best, timer.seconds());
  }
  return best;
}

}  // namespace kage::bench
