// SPDX-License-Identifier: Apache-2.0
//
// Exact edge walking. An edge crosses the centres of the lines y with ceil(top - 1/2) <= y < ceil(bottom - 1/2); on
// such a line its first pixel to the right is ceil(x - 1/2), x being the exact rational crossing. Quotient and
// remainder are carried from line to line, so a shared edge gives every pixel to exactly one side whatever its slope.
// docs/numbers.md, Coverage.
#pragma once

#include <cstdint>

#include "kage/geometry.hpp"
#include "number/first_centre.hpp"

namespace kage {

/// Quotient rounded down and remainder 0 .. b - 1, for b > 0.
template <class Int>
struct Division {
  Int quotient;
  Int remainder;
};
template <class Int>
constexpr Division<Int> divide_floor(Int a, Int b) {
  Division<Int> d{a / b, a % b};
  if (d.remainder < 0) {
    --d.quotient;
    d.remainder += b;
  }
  return d;
}

/// One edge on its way down.
class EdgeWalker {
 public:
  EdgeWalker() = default;

  /// The edge from `a` to `b`, to be walked from line `first` on (first() or later).
  EdgeWalker(const ScreenVertex& a, const ScreenVertex& b) {
    const bool down = a.y < b.y;
    top_ = down ? a : b;
    const ScreenVertex& bottom = down ? b : a;
    winding_ = down ? 1 : -1;
    dx_ = std::int64_t{bottom.x} - top_.x;
    dy_ = std::int64_t{bottom.y} - top_.y;
    first_ = first_centre(top_.y);
    end_ = first_centre(bottom.y);
  }

  [[nodiscard]] int first() const { return first_; }
  [[nodiscard]] int end() const { return end_; }
  [[nodiscard]] int winding() const { return winding_; }  ///< +1 for an edge that goes down
  [[nodiscard]] bool active(int y) const { return y >= first_ && y < end_; }

  /// Go to line y, first() <= y < end(). |coordinates| < 2^24, so every product stays below 2^50.
  void start(int y) {
    const std::int64_t scale = 256 * dy_;
    // ceil(n / scale) with n / scale = (x - 128) / 256 at the line's centre.
    const std::int64_t n = (top_.x - 128) * dy_ + (std::int64_t{256} * y + 128 - top_.y) * dx_;
    const auto at = divide_floor(n + scale - 1, scale);
    // 32 bits hold both, and divide faster.
    const auto step = divide_floor(static_cast<std::int32_t>(dx_), static_cast<std::int32_t>(dy_));
    x_ = static_cast<std::int32_t>(at.quotient);
    rest_ = at.remainder - scale;
    step_ = step.quotient;
    rest_step_ = std::int64_t{256} * step.remainder;
    scale_ = scale;
  }

  // Without a branch, for whether the remainder overflows is as good as chance.
  void next() {
    rest_ += rest_step_;
    const auto over = ~(rest_ >> 63);  // all ones, or 0
    rest_ -= scale_ & over;
    x_ += step_ - static_cast<std::int32_t>(over);
  }

  /// First pixel at or right of the crossing.
  [[nodiscard]] int x() const { return x_; }

 private:
  ScreenVertex top_;
  std::int64_t dx_ = 0;
  std::int64_t dy_ = 0;
  // An edge that crosses a line's centre is less than 2^25 long, so a step is less than 2^25 as well.
  std::int32_t x_ = 0;
  std::int32_t step_ = 0;
  std::int64_t rest_ = 0;  // the remainder less scale_
  std::int64_t rest_step_ = 0;
  std::int64_t scale_ = 1;
  int first_ = 0;
  int end_ = 0;
  int winding_ = 0;
};

}  // namespace kage
