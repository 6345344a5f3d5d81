// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/edge.hpp"
#include "pragmas.hpp"

namespace kage::hls {

/// An edge that goes down, and the line on which it is to begin.
struct EdgeSetupIn {
  Subpixel top_x, top_y;        ///< its upper end
  Subpixel bottom_x, bottom_y;  ///< its lower end, on another line than the upper one
  Line line;                    ///< one whose centre it crosses
};

namespace detail {

/// One bit of a quotient: `rest` and the next bit of the dividend against the divisor. Whether the divisor fits is the
/// borrow of the subtraction; a comparison besides would be a second carry chain in series with it.
inline bool divide_step(Rest& rest, bool next, const Rest& divisor) {
  const hw::u<kRestBits + 1> wide = hw::u<kRestBits + 1>(rest) << 1;
  const hw::u<kRestBits + 1> with = wide | hw::u<kRestBits + 1>(next);
  const hw::u<kRestBits + 2> less = hw::u<kRestBits + 2>(with) - hw::u<kRestBits + 2>(divisor);
  const bool fits = hw::slice<1>(less, kRestBits + 1) == hw::u<1>(0);
  rest = fits ? Rest(less) : Rest(with);
  return fits;
}

/// Quotient and remainder of a dividend of 17 bits more than the divisor, which is more than the dividend's upper part.
inline Edge::Pixels divide(const hw::u<kRestBits + 17>& dividend, const Rest& divisor, Rest& rest) {
  hw::u<17> quotient(0);
  rest = Rest(hw::slice<kRestBits>(dividend, 17));
  KAGE_HLS_UNROLL
  for (int i = 16; i >= 0; --i) {
    KAGE_HLS_UNROLLED
    const bool bit = divide_step(rest, hw::slice<1>(dividend, i) == hw::u<1>(1), divisor);
    quotient = quotient << 1;
    quotient = quotient | hw::u<17>(bit);
  }
  return Edge::Pixels(quotient);
}

}  // namespace detail

/// Where an edge crosses the centre of a line, and how it goes on (ref/frontend/edge_walker.hpp; docs/numbers.md,
/// Coverage). With dx, dy its width and height and n = (x - 128) dy + (256 y + 128 - y_top) dx the first pixel to the
/// right is ceil(n / (256 dy)), which is floor(floor((n + 256 dy - 1) / 256) / dy). The remainder of the outer division
/// is all that its steps need, as they add multiples of 256 dy / 256 to it.
inline void edge_setup(const EdgeSetupIn& in, Edge& out) {
  using Long = hw::s<51>;
  const hw::s<25> dx = hw::s<25>(in.bottom_x) - hw::s<25>(in.top_x);
  const hw::s<25> dy = hw::s<25>(in.bottom_y) - hw::s<25>(in.top_y);
  const hw::s<25> left = hw::s<25>(in.top_x) - hw::s<25>(128);
  const hw::s<26> centre = hw::s<26>(hw::s<26>(in.line) << 8);
  const hw::s<26> past = centre + hw::s<26>(128);
  const hw::s<26> down = past - hw::s<26>(in.top_y);
  const Long across = Long(left) * Long(dy);
  const Long along = Long(down) * Long(dx);
  const Long n = across + along;
  const Long scale = Long(dy) << 8;
  const Long up = n + scale;
  const Long least = up - Long(1);
  // 2^16 pixels further right nothing is negative.
  const Long right = Long(dy) << 24;
  const Long moved = least + right;
  const Rest divisor(dy);
  Rest rest, rest_step;
  const Edge::Pixels x = detail::divide(hw::slice<kRestBits + 17>(moved, 8), divisor, rest);
  const hw::s<kRestBits + 18> far = hw::s<kRestBits + 18>(dy) << 16;
  const hw::s<kRestBits + 18> steep = hw::s<kRestBits + 18>(dx) + far;
  const Edge::Pixels step = detail::divide(hw::u<kRestBits + 17>(steep), divisor, rest_step);
  out.x = x - Edge::Pixels(1 << 16);
  out.step = step - Edge::Pixels(1 << 16);
  out.rest = rest;
  out.rest_step = rest_step;
  out.dy = divisor;
}

}  // namespace kage::hls
