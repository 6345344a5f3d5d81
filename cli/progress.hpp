// SPDX-License-Identifier: Apache-2.0
//
// How far a run has come, on standard error; of frames: how many, at what rate, and how long the rest will take.
#pragma once

#include <chrono>
#include <string>

namespace kage::cli {

/// How far work has come, on standard error: on a terminal a line that is written over and over; in a pipe, a file or
/// on a dumb terminal a line every ten seconds, so none where the work does not last. $KAGE_PROGRESS is another number
/// of seconds, 0: no lines.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const std::string& text);
  void clear();

 private:
  bool terminal_ = false;
  bool shown_ = false;
  std::chrono::duration<double> pause_{10};  // between lines where there is no terminal
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

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

}  // namespace kage::cli
