// SPDX-License-Identifier: Apache-2.0
#include "image/png_chunks.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace kage {
namespace {

std::uint32_t number(const unsigned char* at) {
  return static_cast<std::uint32_t>(at[0]) << 24 | static_cast<std::uint32_t>(at[1]) << 16 |
         static_cast<std::uint32_t>(at[2]) << 8 | at[3];
}

}  // namespace

PngChunks read_png_chunks(const std::filesystem::path& path) {
  PngChunks found;
  std::ifstream in(path, std::ios::binary);
  std::array<unsigned char, 32> bytes{};
  const auto read = [&](std::size_t size) {
    return static_cast<bool>(in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)));
  };
  if (!read(8) || std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8) != 0) return found;
  while (read(8)) {
    const std::uint32_t size = number(bytes.data());
    const std::string tag(reinterpret_cast<const char*>(bytes.data()) + 4, 4);
    const std::streamoff next = static_cast<std::streamoff>(in.tellg()) + size + 4;  // behind the checksum
    if (tag == "IDAT" || tag == "IEND") break;
    if (tag == "acTL") found.animated = true;
    if (tag == "IHDR" && size == 13 && read(13) && bytes[9] != 3) found.bits = bytes[8];
    if (tag == "cHRM" && size == 32 && read(32))
      for (std::size_t i = 0; i < 32; i += 4)
        found.chromaticities += fmt::format("{}{}", i == 0 ? "" : " ", number(&bytes[i]));
    if (!in.seekg(next)) break;
  }
  return found;
}

}  // namespace kage
