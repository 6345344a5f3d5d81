// SPDX-License-Identifier: Apache-2.0
//
// A span's depth and colour at one pixel, straight from the definition (docs/stream.md), for code that looks at single
// pixels. The kernels step from pixel to pixel instead.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "contract/derived.hpp"
#include "kage/token.hpp"
#include "number/bits.hpp"

namespace kage {

/// Depth at pixel x: 1 .. 2^Z_BITS - 2.
inline std::uint32_t span_depth(const Config& c, const SpanToken& s, int x) {
  const std::int64_t sum = sign_extend(
      static_cast<std::uint64_t>(s.z) + static_cast<std::uint64_t>(s.dz) * static_cast<std::uint64_t>(x - s.xl),
      derived::depth_bits(c));
  const std::int64_t most = derived::most_depth(c);
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(sum >> c.z_frac, 1, most));
}

/// Colour at pixel x.
inline std::array<std::uint8_t, 3> span_color(const Config& c, const SpanToken& s, int x) {
  std::array<std::uint8_t, 3> color{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i) {
    if (c.smooth == 0) {
      color[i] = static_cast<std::uint8_t>(s.color[i]);
      continue;
    }
    const std::int64_t sum =
        sign_extend(static_cast<std::uint64_t>(std::int64_t{s.color[i]} + std::int64_t{s.dcolor[i]} * (x - s.xl)),
                    derived::ramp_bits(c));
    color[i] = static_cast<std::uint8_t>(std::clamp<std::int64_t>(sum >> c.color_frac, 0, 255));
  }
  return color;
}

}  // namespace kage
