// SPDX-License-Identifier: Apache-2.0
//
// How far a run has come, on standard error.
#pragma once

#include <chrono>
#include <string>

#include "kage/cosim.hpp"

namespace kage::cli {

/// How far work has come, on standard error. On a terminal it is one line that is written over and over. In a pipe, a
/// file or on a dumb terminal it is a line every ten seconds, so none where the work does not last. $KAGE_PROGRESS is
/// another number of seconds, 0: no lines.
class Progress final : public cosim::Progress {
 public:
  Progress();
  ~Progress() override;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const std::string& text) override;
  void clear() override;

 private:
  bool terminal_ = false;
  bool shown_ = false;
  std::chrono::duration<double> pause_{10};  // between lines where there is no terminal
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace kage::cli
