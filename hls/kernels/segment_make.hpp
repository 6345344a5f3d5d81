// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "types.hpp"

namespace kage::hls {

/// A run of one face, or of nothing, on a unit's line, as far as it is not in segments yet.
template <int X_BITS, int DEPTH_BITS>
struct SegmentMakeIn {
  hw::u<X_BITS> at;         ///< its first pixel
  hw::u<X_BITS> end;        ///< one past its last
  hw::s<DEPTH_BITS> depth;  ///< at `at`
  hw::s<DEPTH_BITS> step;   ///< a pixel
};

template <int X_BITS, int DX_BITS, int DEPTH_BITS>
struct SegmentMakeOut {
  hw::u<1> sync;            ///< the segment is the first of its line
  hw::u<DX_BITS> dx;        ///< its pixels
  hw::u<1> last;            ///< the run ends with it
  hw::u<X_BITS> at;         ///< where the run goes on
  hw::s<DEPTH_BITS> depth;  ///< there
};

/// The next segment of a run [Ohno 1985: SYNC, length, Z]: as long as DX_BITS can say, or as the run is.
template <int X_BITS, int DX_BITS, int DEPTH_BITS>
void segment_make(const SegmentMakeIn<X_BITS, DEPTH_BITS>& in, SegmentMakeOut<X_BITS, DX_BITS, DEPTH_BITS>& out) {
  using Pixels = hw::u<X_BITS + 1>;
  using Depth = hw::s<DEPTH_BITS>;
  const Pixels most((1 << DX_BITS) - 1 < (1 << X_BITS) - 1 ? (1 << DX_BITS) - 1 : (1 << X_BITS) - 1);
  const Pixels left = Pixels(in.end) - Pixels(in.at);
  const bool fits = left <= most;
  const Pixels dx = fits ? left : most;
  const Pixels at = Pixels(in.at) + dx;
  const Depth moved = in.step * Depth(dx);
  out.sync = hw::u<1>(in.at == hw::u<X_BITS>(0));
  out.dx = hw::u<DX_BITS>(dx);
  out.last = hw::u<1>(fits);
  out.at = hw::u<X_BITS>(at);
  out.depth = in.depth + moved;
}

}  // namespace kage::hls
