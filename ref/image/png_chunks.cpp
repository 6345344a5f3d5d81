// SPDX-License-Identifier: Apache-2.0
#include "image/png_chunks.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

#include "kage/error.hpp"

namespace kage {
namespace {

std::uint32_t number(const unsigned char* at, std::uint32_t bytes = 4) {
  std::uint32_t value = 0;
  for (std::uint32_t i = 0; i < bytes; ++i) value = value << 8 | at[i];
  return value;
}

/// Chunks of numbers of one size: a tag, the number's bytes, and where they go to as text.
struct Numbers {
  const char* tag;
  std::uint32_t bytes;
  std::string* text;
};

}  // namespace

PngChunks read_png_chunks(const std::filesystem::path& path) {
  PngChunks found;
  std::ifstream in(path, std::ios::binary);
  std::array<unsigned char, 32> bytes{};
  const auto read = [&](std::size_t size) {
    return static_cast<bool>(in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)));
  };
  const Numbers numbers[] = {{"cHRM", 4, &found.chromaticities}, {"gAMA", 4, &found.gamma},
                             {"sRGB", 1, &found.intent},         {"cICP", 1, &found.more[0].second},
                             {"sBIT", 1, &found.more[1].second}, {"mDCV", 2, &found.more[2].second},
                             {"cLLI", 4, &found.more[3].second}};
  if (!in) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::generic_category().message(errno)));
  if (!read(8) || std::memcmp(bytes.data(), "\x89PNG\r\n\x1a\n", 8) != 0) return found;
  while (read(8)) {
    const std::uint32_t size = number(bytes.data());
    const std::string tag(reinterpret_cast<const char*>(bytes.data()) + 4, 4);
    const std::streamoff next = static_cast<std::streamoff>(in.tellg()) + size + 4;  // behind the checksum
    if (tag == "IDAT" || tag == "IEND") break;
    if (tag == "acTL") found.animated = true;
    if (tag == "iCCP") found.profile = true;
    if (tag == "IHDR" && size == 13 && read(13)) {
      if (bytes[9] != 3) found.bits = bytes[8];
      found.interlaced = bytes[12] != 0;
    }
    for (const Numbers& n : numbers) {
      if (tag != n.tag || size > bytes.size() || size % n.bytes != 0 || !read(size)) continue;
      for (std::size_t i = 0; i < size; i += n.bytes)
        *n.text += fmt::format("{}{}", n.text->empty() ? "" : " ", number(&bytes[i], n.bytes));
    }
    if (!in.seekg(next)) break;
  }
  return found;
}

}  // namespace kage
