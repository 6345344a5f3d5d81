// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "types.hpp"

namespace kage::hls {

/// A pixel in the compare tree: a key and what goes with it.
template <int KEY_BITS, int REST_BITS>
struct TreePoint {
  hw::u<KEY_BITS> key;    ///< {Z, draw index}
  hw::u<REST_BITS> rest;  ///< {class, colour}
};

template <int KEY_BITS, int REST_BITS>
struct CompareCellIn {
  TreePoint<KEY_BITS, REST_BITS> left;
  TreePoint<KEY_BITS, REST_BITS> right;
};

/// The nearer of two pixels; of equal keys the left one [Ohno 1985].
template <int KEY_BITS, int REST_BITS>
void compare_cell(const CompareCellIn<KEY_BITS, REST_BITS>& in, TreePoint<KEY_BITS, REST_BITS>& out) {
  const bool right = in.right.key < in.left.key;
  out.key = right ? in.right.key : in.left.key;
  out.rest = right ? in.right.rest : in.left.rest;
}

}  // namespace kage::hls
