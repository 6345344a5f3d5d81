// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/edge.hpp"

namespace kage::hls {

/// The edge on the next line: quotient and remainder one step on, with a carry where the remainder reaches the height.
inline void edge_step(const Edge& in, Edge& out) {
  using Wide = hw::u<kRestBits + 2>;
  const Wide sum = Wide(in.rest) + Wide(in.rest_step);
  const Wide less = sum - Wide(in.dy);
  const bool carry = hw::slice<1>(less, kRestBits + 1) == hw::u<1>(0);
  const Edge::Pixels on = in.x + in.step;
  out.x = on + Edge::Pixels(carry);
  out.step = in.step;
  out.rest = carry ? Rest(less) : Rest(sum);
  out.rest_step = in.rest_step;
  out.dy = in.dy;
}

}  // namespace kage::hls
