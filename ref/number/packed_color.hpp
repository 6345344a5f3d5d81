// SPDX-License-Identifier: Apache-2.0
//
// Colours in one number, as a header's background has them: channel c in bits 8c .. 8c + 7.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kage {

inline constexpr unsigned kPackedBits = 24;  ///< what lies above is no colour

/// The first `channels` of three, each 0 .. 255.
template <class Channel>
constexpr std::uint32_t packed_color(const std::array<Channel, 3>& color, int channels = 3) {
  std::uint32_t all = 0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
    all |= static_cast<std::uint32_t>(color[c]) << 8 * c;
  return all;
}

/// The lowest `channels`, whatever lies above them; the others are 0.
constexpr std::array<std::uint8_t, 3> unpacked_color(std::uint64_t all, int channels = 3) {
  std::array<std::uint8_t, 3> color{};
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
    color[c] = static_cast<std::uint8_t>(all >> 8 * c);
  return color;
}

}  // namespace kage
