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

/// The same of levels of `bits` bits, at most 16.
template <class Channel>
constexpr std::uint64_t packed_levels(const std::array<Channel, 3>& color, int bits, int channels = 3) {
  std::uint64_t all = 0;
  for (int c = 0; c < channels; ++c) all |= static_cast<std::uint64_t>(color[static_cast<std::size_t>(c)]) << bits * c;
  return all;
}

/// The lowest `channels` of such, whatever lies above them; the others are 0.
constexpr std::array<std::uint16_t, 3> unpacked_levels(std::uint64_t all, int bits, int channels = 3) {
  std::array<std::uint16_t, 3> color{};
  for (int c = 0; c < channels; ++c)
    color[static_cast<std::size_t>(c)] = static_cast<std::uint16_t>(all >> bits * c & ((std::uint64_t{1} << bits) - 1));
  return color;
}

}  // namespace kage
