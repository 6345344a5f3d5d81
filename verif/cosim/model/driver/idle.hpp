// SPDX-License-Identifier: Apache-2.0
//
// How long a core works without a move at its ports. The model's driver and the test bench of packs of vectors call a
// core hung behind that.
#pragma once

#include <cstdint>

/// More clocks than a core of these parameters takes for what one token asks of it, with nothing taken at its input and
/// nothing given at its output. Without a front end that is a line's sweep and the token's own pass over its pixels.
/// With one, a token may let all polygons of the line go first, `active` at most. Each of them has a span, and at most
/// an EV and an ES behind it, which are passes over at most a line.
constexpr std::uint64_t idle_clocks(std::uint64_t max_width, std::uint64_t lanes, std::uint64_t active) {
  const std::uint64_t pass = (max_width + lanes - 1) / lanes + 16;
  return 8 * max_width + 4096 + 3 * active * pass;
}
