// SPDX-License-Identifier: Apache-2.0
//
// When the streams stop: see stalls() of rtl_model.h.
#pragma once

#include <cstdint>

/// xorshift64*: small, and the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 0xD1B54A32D192ED03ULL) {
    if (state_ == 0) state_ = 1;
  }
  std::uint32_t next() {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return static_cast<std::uint32_t>(state_ * 0x2545F4914F6CDD1DULL >> 32);
  }
  std::uint32_t in(std::uint32_t least, std::uint32_t most) { return least + next() % (most - least + 1); }

 private:
  std::uint64_t state_;
};

/// A stream that goes in so many of 65536 clocks. It stops for a clock most often, sometimes for a burst of them, and
/// now and then for longer than any buffer lasts; what goes between two stops is as long as the share needs.
class Flow {
 public:
  explicit Flow(std::uint32_t share = 65536, std::uint64_t seed = 1)
      : random_(seed), share_(share < 65536 ? share : 65536) {
    if (share_ != 0 && share_ != 65536) go(1 + random_.in(0, 15));
  }

  /// Whether it goes in the next clock.
  bool next() {
    if (share_ == 0 || share_ == 65536) return share_ != 0;
    while (left_ == 0) going_ ? stop() : go(stopped_);
    --left_;
    return going_;
  }

 private:
  void stop() {
    const std::uint32_t manner = random_.in(0, 63);
    left_ = stopped_ = manner == 0 ? random_.in(64, 511) : manner < 9 ? random_.in(2, 32) : 1;
    going_ = false;
  }
  /// For as long as a stop of so many clocks asks for, on the average.
  void go(std::uint64_t stopped) {
    const std::uint64_t mean = stopped * share_ * 256 / (65536 - share_);  // in 1/256 clocks
    const std::uint64_t random = std::uint64_t{random_.next()} << 32 | random_.next();
    left_ = (random % (2 * mean + 1) + random_.in(0, 255)) / 256;
    going_ = true;
  }

  Random random_;
  std::uint32_t share_;
  bool going_ = true;
  std::uint64_t left_ = 0;
  std::uint64_t stopped_ = 0;
};
