// SPDX-License-Identifier: Apache-2.0
//
// A run on several threads: each has a core of its own and a range of consecutive frames. The result is that of a run
// on one thread.
#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include "cosim/run.hpp"

namespace kage::cosim {

/// Some of a run's frames: steps.first, steps.first + steps.step, ... below `end`.
struct FrameRange {
  FrameSteps steps;
  int end = 0;
  int before = 0;  ///< RunOptions::before: one where there is a frame before, so that the range meets what that left
};

/// The steps below `frames` in `ranges` ranges, as even as can be, or as many as there are frames. At least one.
std::vector<FrameRange> split(const FrameSteps& steps, int frames, int ranges);

/// The ranges of a run as they go on, told by several threads: how far any of them needs to go.
class RunState {
 public:
  /// A difference in a frame, or trouble with it: what lies behind it is of no interest.
  void ends_at(int frame) {
    int last = last_;
    while (frame < last && !last_.compare_exchange_weak(last, frame)) {
    }
  }
  /// All frames are of interest again.
  void goes_on() { last_ = std::numeric_limits<int>::max(); }

  /// Whether nobody asks for this frame any more.
  [[nodiscard]] bool beyond(int frame) const { return frame > last_; }

 private:
  std::atomic<int> last_{std::numeric_limits<int>::max()};
};

/// The reports of ranges, in their order, as that of one run: up to the first difference.
Report join(std::vector<Report> ranges);

}  // namespace kage::cosim
