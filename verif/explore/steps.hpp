// SPDX-License-Identifier: Apache-2.0
//
// Steps in a penumbra: N samples of a light give at most N + 1 shares of shadow, so what is smooth for an area is a
// staircase for its samples.
#pragma once

#include <cstdint>

#include "explore/accuracy.hpp"

namespace kage::explore {

/// A jump of colour between neighbours counts as a step where it exceeds the finest picture's by this many steps of
/// 255. Less may come from rounding alone: each of the four colours is rounded by up to a half, 2 together.
inline constexpr int kLeastStep = 3;

/// Neighbours (to the right, below) that show the same face in both pictures.
struct Steps {
  std::uint64_t seen = 0;  ///< pairs whose colours are at least kLeastStep further apart than in the finest picture
  int most = 0;            ///< by how much at most, in steps of 255, in any channel

  Steps& operator+=(const Steps& o);
};

Steps steps_of(const DrawnFrame& finest, const DrawnFrame& drawn);

}  // namespace kage::explore
