// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <utility>

#include "kage/core.hpp"

namespace kage {

/// Adds to `seconds` the time it lives, but not what a sink takes.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~Stopwatch() { stop(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  /// `sink`, with the watch standing still inside it.
  LineSink outside(const LineSink& sink) {
    return [this, &sink](int y, std::span<const std::uint8_t> pixels) {
      stop();
      const Restart restart{start_};  // even if the sink throws: its time is never counted
      sink(y, pixels);
    };
  }

 private:
  using Clock = std::chrono::steady_clock;

  struct Restart {
    Clock::time_point& start;
    ~Restart() { start = Clock::now(); }
  };

  void stop() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }

  double& seconds_;
  Clock::time_point start_;
};

}  // namespace kage
