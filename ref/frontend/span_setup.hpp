// SPDX-License-Identifier: Apache-2.0
//
// Start values and slopes of spans from planes. docs/numbers.md, Depth along a span.
#pragma once

#include <algorithm>

#include "contract/derived.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"
#include "number/int128.hpp"

namespace kage {

/// The class of a polygon's spans: of its normal, or, without table, whether it is lit.
inline int span_class(const ScreenPolygon& p, const Config& config) {
  if (derived::has_table(config)) return static_cast<int>(p.normal_class);
  return p.lit ? 1 : 0;
}

/// A plane's value at a pixel centre, exactly, in 2^-24.
inline Int128 value_at(const ScreenPlane& p, int x, int y) {
  return static_cast<Int128>(p.c) + static_cast<Int128>(p.a) * (x - p.x0) + static_cast<Int128>(p.b) * (y - p.y0);
}

/// Rounds planes into the fields of a span.
class SpanSetup {
 public:
  /// `frac` fraction bits in an accumulator of `bits` bits, of which a pixel leaves out so many.
  SpanSetup(int frac, int bits, int left_out)
      : shift_(kPlaneFrac - frac),
        limit_(std::int64_t{1} << (bits - 1)),
        half_(left_out > 0 ? std::int64_t{1} << (left_out - 1) : 0),
        round_half_(shift_ > 0 ? std::int64_t{1} << (shift_ - 1) : 0) {}

  /// For the depth of spans and segments.
  static SpanSetup depth(const Config& config) { return {config.z_frac, derived::depth_bits(config), config.z_frac}; }
  /// For the colour of spans, of which a pixel takes so many bits a channel.
  static SpanSetup color(const Config& config, int level_bits) {
    return {config.color_frac, derived::smooth_bits(config), config.color_frac + 8 - level_bits};
  }

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

  /// The half that a start gets, in 2^-24.
  [[nodiscard]] std::int64_t half() const { return half_ << shift_; }

  /// The step of a plane, whatever the span: what at() gives to every span that stays in range.
  [[nodiscard]] std::int64_t step(const ScreenPlane& plane) const {
    return static_cast<std::int64_t>(clamp(round(plane.a)));
  }

  /// Call emit(xl, xr, ramp) for the parts of [xl, xr) that are within the accumulator's range, before it and past it:
  /// one part for every plane that geometry makes. Outside the range a part is constant, so that clamping holds where
  /// the plane itself does not fit.
  template <class Emit>
  void each(const ScreenPlane& plane, int xl, int xr, int y, Emit emit) const {
    if (is_narrow(plane)) {
      const std::int64_t left = plane.c + plane.a * (xl - plane.x0) + plane.b * (y - plane.y0);
      const std::int64_t last = xr - 1 - xl;
      const std::int64_t start = round_narrow(left) + half_;
      const std::int64_t step = last > 0 ? round_narrow(plane.a) : 0;
      if (in_range(start) && in_range(round_narrow(left + plane.a * last) + half_) && in_range(step) &&
          in_range(start + step * last)) {
        emit(xl, xr, Ramp{start, step});
        return;
      }
    }
    each_wide(plane, xl, xr, y, emit);
  }

 private:
  // Whether 64 bits hold all of a span's sums, as they do for planes that are not very steep. Pixels of a picture and
  // anchors lie within +-2^15. So x - x0 and y - y0 lie within 2^16, and c + a (x - x0) + b (y - y0) within 3 * 2^60.
  // The halves that are added to it are at most 2^23. After rounding, a start in range (2^(bits - 1) <= 2^49) and
  // 2^15 steps of at most 2^44 + 1 stay below 2^60.
  [[nodiscard]] static bool is_narrow(const ScreenPlane& p) {
    const auto within = [](std::int64_t v, int log) {
      return static_cast<std::uint64_t>(v) + (std::uint64_t{1} << log) <= std::uint64_t{2} << log;
    };
    return within(p.a, 44) && within(p.b, 44) && within(p.c, 60) && within(p.x0, 15) && within(p.y0, 15);
  }
  [[nodiscard]] std::int64_t round_narrow(std::int64_t v) const { return (v + round_half_) >> shift_; }
  [[nodiscard]] bool in_range(std::int64_t v) const { return v >= -limit_ && v < limit_; }

  // The same as each() for any plane.
  template <class Emit>
  [[gnu::noinline]] void each_wide(const ScreenPlane& plane, int xl, int xr, int y, Emit emit) const {
    if (range_of(start(plane, xl, y)) == 0 && range_of(start(plane, xr - 1, y)) == 0) {
      emit(xl, xr, at(plane, xl, y, xr - xl));
      return;
    }
    for (int x = xl; x < xr;) {
      const Int128 first = start(plane, x, y);
      int end = x + 1;
      while (end < xr && range_of(start(plane, end, y)) == range_of(first)) ++end;
      emit(x, end, range_of(first) == 0 ? at(plane, x, y, end - x) : Ramp{static_cast<std::int64_t>(clamp(first)), 0});
      x = end;
    }
  }

  [[nodiscard]] Int128 start(const ScreenPlane& plane, int x, int y) const {
    return round(value_at(plane, x, y)) + half_;
  }
  [[nodiscard]] Int128 clamp(Int128 v) const {
    return std::clamp(v, -static_cast<Int128>(limit_), static_cast<Int128>(limit_) - 1);
  }
  [[nodiscard]] int range_of(Int128 v) const { return v < -limit_ ? -1 : v >= limit_ ? 1 : 0; }
  [[nodiscard]] Int128 round(Int128 v) const { return (v + round_half_) >> shift_; }

  int shift_;
  std::int64_t limit_;
  std::int64_t half_;
  std::int64_t round_half_;
};

}  // namespace kage
