// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "types.hpp"

namespace kage::hls {

/// A plane at the first pixel of a polygon's span, and the way to the first pixel of its next span.
template <int BITS>
struct PlaneStepIn {
  hw::s<BITS> value;  ///< in 2^-24
  hw::s<BITS> right;  ///< slope to the right, a pixel
  hw::s<BITS> down;   ///< slope down, a line
  hw::s<17> move;     ///< from the first pixel of this line's span to that of the next one, in pixels
};

template <int BITS>
struct PlaneStepOut {
  hw::s<BITS> value;  ///< at the first pixel of the next span
};

/// A plane's value from line to line: exact, because all sums wrap and the value at a span's first pixel is known to
/// fit.
template <int BITS>
void plane_step(const PlaneStepIn<BITS>& in, PlaneStepOut<BITS>& out) {
  using Value = hw::s<BITS>;
  const Value along = in.right * Value(in.move);
  const Value below = in.value + in.down;
  out.value = below + along;
}

}  // namespace kage::hls
