// SPDX-License-Identifier: Apache-2.0
//
// Fragments of translucent faces on a line of pixels.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kage/geometry.hpp"

namespace kage {

/// Restrict the pixels [xl, xr) of line y, within the screen, to those on one side of a cut. Every pixel is on one side
/// or the other, so what both sides get of [xl, xr) is just that.
inline void restrict_to(const CutLine& cut, bool front, int y, int& xl, int& xr) {
  const std::int64_t at_0 = cut.b * y + cut.c;  // |b y| <= 2^45, |c| <= 2^58
  if (cut.a == 0) {
    if ((at_0 >= 0) != front) xr = xl;
    return;
  }
  // Pixels before the plane: a x >= -at_0. So x >= ceil(-at_0 / a) if a > 0, else x <= floor(-at_0 / a).
  const auto floor_div = [](std::int64_t n, std::int64_t d) { return n / d - (n % d != 0 && (n < 0) != (d < 0)); };
  const bool right = (cut.a > 0) == front;  // the side wanted is to the right of the border
  const std::int64_t border = cut.a > 0 ? -floor_div(at_0, cut.a) : floor_div(-at_0, cut.a) + 1;
  if (right)
    xl = static_cast<int>(std::clamp<std::int64_t>(border, xl, xr));
  else
    xr = static_cast<int>(std::clamp<std::int64_t>(border, xl, xr));
}

}  // namespace kage
