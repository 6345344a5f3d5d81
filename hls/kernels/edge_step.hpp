// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/edge.hpp"

namespace kage::hls {

/// The edge on the next line: quotient and remainder one step on, with a carry where the remainder reaches the height.
template <int WHOLE, int FRAC>
void edge_step(const EdgeOf<WHOLE, FRAC>& in, EdgeOf<WHOLE, FRAC>& out) {
  using Pixels = typename EdgeOf<WHOLE, FRAC>::Pixels;
  using Rest = RestOf<WHOLE, FRAC>;
  using Wide = hw::u<WHOLE + FRAC + 2>;
  const Wide sum = Wide(in.rest) + Wide(in.rest_step);
  const Wide less = sum - Wide(in.dy);
  const bool carry = hw::slice<1>(less, WHOLE + FRAC + 1) == hw::u<1>(0);
  const Pixels on = in.x + in.step;
  out.x = on + Pixels(carry);
  out.step = in.step;
  out.rest = carry ? Rest(less) : Rest(sum);
  out.rest_step = in.rest_step;
  out.dy = in.dy;
}

}  // namespace kage::hls
