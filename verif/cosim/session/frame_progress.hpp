// SPDX-License-Identifier: Apache-2.0
//
// How far a run has come: how many frames, at what rate, and how long the rest will take.
#pragma once

#include <chrono>
#include <string>

#include "kage/cosim.hpp"

namespace kage::cosim {

/// "courtyard: frame 3/8, 1.6 frames/s, 4 s left". `done` frames took `seconds`; before the first is done, and for less
/// than a tenth of a second, there is no rate.
std::string progress_text(const std::string& name, int done, int frames, double seconds);

/// Shows it as frames begin, and while a frame lasts.
class FrameProgress {
 public:
  /// `progress` must outlive it. `name` is what the frames are of.
  FrameProgress(Progress& progress, std::string name, int frames);

  /// The next frame begins.
  void next();

  /// The frame goes on; to be called several times a second.
  void wait();

 private:
  Progress& progress_;
  std::string name_;
  int frames_;
  int done_ = -1;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point frame_start_;
};

}  // namespace kage::cosim
