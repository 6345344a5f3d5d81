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

/// Colour at pixel x, in channels of derived::lane_level_bits().
inline std::array<std::uint32_t, 3> span_levels(const Config& c, const SpanToken& s, int x) {
  const int more = derived::lane_level_bits(c) - 8;
  std::array<std::uint32_t, 3> color{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i) {
    if (c.smooth == 0) {
      color[i] = static_cast<std::uint32_t>(s.color[i]);
      continue;
    }
    const std::int64_t sum =
        sign_extend(static_cast<std::uint64_t>(std::int64_t{s.color[i]} + std::int64_t{s.dcolor[i]} * (x - s.xl)),
                    derived::ramp_bits(c));
    color[i] = static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(sum >> (c.color_frac - more), 0, (std::int64_t{256} << more) - 1));
  }
  return color;
}

/// The same in the channels of a pixel: as an OP gives it to one that it covers, or, `displayed`, as a TP brings it.
inline std::array<std::uint16_t, 3> span_color(const Config& c, const SpanToken& s, int x, bool displayed) {
  const int less = derived::lane_level_bits(c) - (displayed ? 8 : derived::pixel_level_bits(c));
  const std::array<std::uint32_t, 3> levels = span_levels(c, s, x);
  std::array<std::uint16_t, 3> color{};
  for (std::size_t i = 0; i < 3; ++i) color[i] = static_cast<std::uint16_t>(levels[i] >> less);
  return color;
}

}  // namespace kage
