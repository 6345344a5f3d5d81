// SPDX-License-Identifier: Apache-2.0
//
// Start values and slopes of spans from planes. docs/numbers.md, Depth along a span.
#pragma once

#include <algorithm>

#include "kage/geometry.hpp"
#include "kage/stream.hpp"
#include "number/int128.hpp"

namespace kage {

/// A plane's value at a pixel centre, exactly, in 2^-24.
inline Int128 value_at(const ScreenPlane& p, int x, int y) {
  return static_cast<Int128>(p.c) + static_cast<Int128>(p.a) * (x - p.x0) + static_cast<Int128>(p.b) * (y - p.y0);
}

/// Rounds planes into the fields of a span.
class SpanSetup {
 public:
  /// `frac` fraction bits in an accumulator of `bits` bits.
  SpanSetup(int frac, int bits) : shift_(kPlaneFrac - frac), limit_(std::int64_t{1} << (bits - 1)), half_(frac > 0 ? std::int64_t{1} << (frac - 1) : 0) {}

  struct Ramp {
    std::int64_t start;
    std::int64_t step;
  };

  /// Start at (x, y), half an LSB included, and step for a span of `count` pixels. Each is rounded to nearest, halves up; a start out of the
  /// accumulator's range is clamped, and a step that would leave the range before the last pixel is made as steep as fits.
  [[nodiscard]] Ramp at(const ScreenPlane& plane, int x, int y, int count) const {
    const Int128 value = round(value_at(plane, x, y)) + half_;
    Ramp r{static_cast<std::int64_t>(std::clamp(value, -static_cast<Int128>(limit_), static_cast<Int128>(limit_) - 1)), 0};
    if (count > 1) {
      const Int128 up = (static_cast<Int128>(limit_) - 1 - r.start) / (count - 1);
      const Int128 down = -((static_cast<Int128>(r.start) + limit_) / (count - 1));
      r.step = static_cast<std::int64_t>(std::clamp(round(plane.a), down, up));
    }
    return r;
  }

 private:
  [[nodiscard]] Int128 round(Int128 v) const { return shift_ == 0 ? v : (v + (static_cast<Int128>(1) << (shift_ - 1))) >> shift_; }

  int shift_;
  std::int64_t limit_;
  std::int64_t half_;
};

}  // namespace kage
