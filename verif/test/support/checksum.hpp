// SPDX-License-Identifier: Apache-2.0
// Checksums that a test's .inc file holds.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "kage/stream.hpp"

namespace kage::verif {

/// CRC-32 over `data`, going on from `sum`: 0 at first.
template <class T>
void add_checksum(std::uint32_t& sum, std::span<const T> data) {
  static_assert(std::is_unsigned_v<T>);
  sum = static_cast<std::uint32_t>(crc32_z(sum, reinterpret_cast<const Bytef*>(data.data()), data.size_bytes()));
}

/// CRC-32 over a frame's words as if their header held parameter hash 0, going on from `sum`. A new parameter, which
/// changes every configuration's hash, leaves this checksum alone.
inline void add_frame_checksum(std::uint32_t& sum, std::vector<std::uint32_t> words) {
  FrameHeader header = FrameHeader::read(words);
  header.param_hash = 0;
  header.write(words);
  add_checksum(sum, std::span<const std::uint32_t>(words));
}

}  // namespace kage::verif
