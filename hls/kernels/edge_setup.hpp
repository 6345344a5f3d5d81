// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/edge.hpp"
#include "pragmas.hpp"

namespace kage::hls {

/// An edge that goes down, and the line on which it is to begin.
template <int WHOLE, int FRAC>
struct EdgeSetupInOf {
  SubpixelOf<WHOLE, FRAC> top_x, top_y;        ///< its upper end
  SubpixelOf<WHOLE, FRAC> bottom_x, bottom_y;  ///< its lower end, on another line than the upper one
  LineOf<WHOLE> line;                          ///< one whose centre it crosses
};
using EdgeSetupIn = EdgeSetupInOf<16, 8>;

namespace detail {

/// One bit of a quotient: `rest` and the next bit of the dividend against the divisor. Whether the divisor fits is the
/// borrow of the subtraction; a comparison besides would be a second carry chain in series with it.
template <int REST>
bool divide_step(hw::u<REST>& rest, bool next, const hw::u<REST>& divisor) {
  const hw::u<REST + 1> wide = hw::u<REST + 1>(rest) << 1;
  const hw::u<REST + 1> with = wide | hw::u<REST + 1>(next);
  const hw::u<REST + 2> less = hw::u<REST + 2>(with) - hw::u<REST + 2>(divisor);
  const bool fits = hw::slice<1>(less, REST + 1) == hw::u<1>(0);
  rest = fits ? hw::u<REST>(less) : hw::u<REST>(with);
  return fits;
}

/// Quotient and remainder of a dividend of BITS bits more than the divisor, which is more than the dividend's upper
/// part.
template <int REST, int BITS>
hw::s<BITS> divide(const hw::u<REST + BITS>& dividend, const hw::u<REST>& divisor, hw::u<REST>& rest) {
  hw::u<BITS> quotient(0);
  rest = hw::u<REST>(hw::slice<REST>(dividend, BITS));
  KAGE_HLS_UNROLL
  for (int i = BITS - 1; i >= 0; --i) {
    KAGE_HLS_UNROLLED
    const bool bit = divide_step<REST>(rest, hw::slice<1>(dividend, i) == hw::u<1>(1), divisor);
    quotient = quotient << 1;
    quotient = quotient | hw::u<BITS>(bit);
  }
  return hw::s<BITS>(quotient);
}

}  // namespace detail

/// Where an edge crosses the centre of a line, and how it goes on (ref/frontend/edge_walker.hpp; docs/numbers.md,
/// Coverage). With dx, dy its width and height and n = (x - 128) dy + (256 y + 128 - y_top) dx the first pixel to the
/// right is ceil(n / (256 dy)), which is floor(floor((n + 256 dy - 1) / 256) / dy). The remainder of the outer division
/// is all that its steps need, as they add multiples of 256 dy / 256 to it. (256 is 2^FRAC, 128 half of it.)
template <int WHOLE, int FRAC>
void edge_setup(const EdgeSetupInOf<WHOLE, FRAC>& in, EdgeOf<WHOLE, FRAC>& out) {
  constexpr int kBits = WHOLE + FRAC;  // of a coordinate and of a remainder
  constexpr int kHalf = 1 << (FRAC - 1);
  using Pixels = typename EdgeOf<WHOLE, FRAC>::Pixels;
  using Rest = RestOf<WHOLE, FRAC>;
  using Long = hw::s<2 * kBits + 3>;
  const hw::s<kBits + 1> dx = hw::s<kBits + 1>(in.bottom_x) - hw::s<kBits + 1>(in.top_x);
  const hw::s<kBits + 1> dy = hw::s<kBits + 1>(in.bottom_y) - hw::s<kBits + 1>(in.top_y);
  const hw::s<kBits + 1> left = hw::s<kBits + 1>(in.top_x) - hw::s<kBits + 1>(kHalf);
  const hw::s<kBits + 2> centre = hw::s<kBits + 2>(hw::s<kBits + 2>(in.line) << FRAC);
  const hw::s<kBits + 2> past = centre + hw::s<kBits + 2>(kHalf);
  const hw::s<kBits + 2> down = past - hw::s<kBits + 2>(in.top_y);
  const Long across = Long(left) * Long(dy);
  const Long along = Long(down) * Long(dx);
  const Long n = across + along;
  const Long scale = Long(dy) << FRAC;
  const Long up = n + scale;
  const Long least = up - Long(1);
  // 2^WHOLE pixels further right nothing is negative.
  const Long right = Long(dy) << kBits;
  const Long moved = least + right;
  const Rest divisor(dy);
  Rest rest, rest_step;
  const Pixels x = detail::divide<kBits, WHOLE + 1>(hw::slice<kBits + WHOLE + 1>(moved, FRAC), divisor, rest);
  const hw::s<kBits + WHOLE + 2> far = hw::s<kBits + WHOLE + 2>(dy) << WHOLE;
  const hw::s<kBits + WHOLE + 2> steep = hw::s<kBits + WHOLE + 2>(dx) + far;
  const Pixels step = detail::divide<kBits, WHOLE + 1>(hw::u<kBits + WHOLE + 1>(steep), divisor, rest_step);
  out.x = x - Pixels(1 << WHOLE);
  out.step = step - Pixels(1 << WHOLE);
  out.rest = rest;
  out.rest_step = rest_step;
  out.dy = divisor;
}

}  // namespace kage::hls
