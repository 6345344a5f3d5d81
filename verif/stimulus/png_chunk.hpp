// SPDX-License-Identifier: Apache-2.0
//
// Chunks of PNG files, for tests and fuzzing of their reader.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

namespace kage::verif {

/// A chunk with its length and its checksum. `tag` has four letters.
inline std::string png_chunk(const std::string& tag, const std::string& data) {
  const auto number = [](std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
      text += static_cast<char>(value >> static_cast<unsigned>(shift) & 255U);
    return text;
  };
  const std::string body = tag + data;
  const auto sum = static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(body.data()), body.size()));
  return number(static_cast<std::uint32_t>(data.size())) + body + number(sum);
}

}  // namespace kage::verif
