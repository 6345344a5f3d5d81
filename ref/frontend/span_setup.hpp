// SPDX-License-Identifier: Apache-2.0
//
// Start values and slopes of spans from planes. docs/numbers.md, Depth along a span.
#pragma once

#include <algorithm>

#include "kage/geometry.hpp"
#include "kage/stream.hpp"
#include "number/int128.hpp"

namespace kage {

/// The class of a polygon's spans: of its normal, or, without table, whether it is lit.
inline int span_class(const ScreenPolygon& p, const Config& config) {
  if (config.class_bits > 1) return p.normal_class;
  return p.lit ? 1 : 0;
}

/// A plane's value at a pixel centre, exactly, in 2^-24.
inline Int128 value_at(const ScreenPlane& p, int x, int y) {
  return static_cast<Int128>(p.c) + static_cast<Int128>(p.a) * (x - p.x0) + static_cast<Int128>(p.b) * (y - p.y0);
}

/// Rounds planes into the fields of a span.
class SpanSetup {
 public:
  /// `frac` fraction bits in an accumulator of `bits` bits.
  SpanSetup(int frac, int bits)
      : shift_(kPlaneFrac - frac),
        limit_(std::int64_t{1} << (bits - 1)),
        half_(frac > 0 ? std::int64_t{1} << (frac - 1) : 0) {}

  /// For the depth of spans and segments.
  static SpanSetup depth(const Config& config) { return {config.z_frac, config.z_bits + config.z_frac + 2}; }

  struct Ramp {
    std::int64_t start;
    std::int64_t step;
  };

  /// Start at (x, y), half an LSB included, and step for a span of `count` pixels. Each is rounded to nearest, halves
  /// up; a start out of the accumulator's range is clamped, and a step that would leave the range before the last pixel
  /// is made as steep as fits.
  [[nodiscard]] Ramp at(const ScreenPlane& plane, int x, int y, int count) const {
    Ramp r{static_cast<std::int64_t>(clamp(start(plane, x, y))), 0};
    if (count > 1) {
      const Int128 step = round(plane.a);
      const Int128 most = static_cast<Int128>(limit_) - 1;
      if (range_of(step) == 0 && range_of(r.start + step * (count - 1)) == 0) {
        r.step = static_cast<std::int64_t>(step);
      } else {
        const Int128 up = std::min(most, (most - r.start) / (count - 1));
        const Int128 down = std::max(-most - 1, -((static_cast<Int128>(r.start) + limit_) / (count - 1)));
        r.step = static_cast<std::int64_t>(std::clamp(step, down, up));
      }
    }
    return r;
  }

  /// The step of a plane, whatever the span: what at() gives to every span that stays in range.
  [[nodiscard]] std::int64_t step(const ScreenPlane& plane) const {
    return static_cast<std::int64_t>(clamp(round(plane.a)));
  }

  /// Call emit(xl, xr, ramp) for the parts of [xl, xr) that are within the accumulator's range, before it and past it:
  /// one part for every plane that geometry makes. Outside the range a part is constant, so that clamping holds where
  /// the plane itself does not fit.
  template <class Emit>
  void each(const ScreenPlane& plane, int xl, int xr, int y, Emit emit) const {
    if (in_range(start(plane, xl, y)) && in_range(start(plane, xr - 1, y))) {
      emit(xl, xr, at(plane, xl, y, xr - xl));
      return;
    }
    for (int x = xl; x < xr;) {
      const Int128 first = start(plane, x, y);
      int end = x + 1;
      while (end < xr && range_of(start(plane, end, y)) == range_of(first)) ++end;
      emit(x, end, in_range(first) ? at(plane, x, y, end - x) : Ramp{static_cast<std::int64_t>(clamp(first)), 0});
      x = end;
    }
  }

 private:
  [[nodiscard]] Int128 start(const ScreenPlane& plane, int x, int y) const {
    return round(value_at(plane, x, y)) + half_;
  }
  [[nodiscard]] Int128 clamp(Int128 v) const {
    return std::clamp(v, -static_cast<Int128>(limit_), static_cast<Int128>(limit_) - 1);
  }
  [[nodiscard]] int range_of(Int128 v) const { return v < -limit_ ? -1 : v >= limit_ ? 1 : 0; }
  [[nodiscard]] bool in_range(Int128 v) const { return range_of(v) == 0; }
  [[nodiscard]] Int128 round(Int128 v) const {
    return shift_ == 0 ? v : (v + (static_cast<Int128>(1) << (shift_ - 1))) >> shift_;
  }

  int shift_;
  std::int64_t limit_;
  std::int64_t half_;
};

}  // namespace kage
