// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace kage {

/// Bytes of a file by their place. Behind the end all are 0, and ended() says that one was asked for.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path) : in_(path, std::ios::binary) {}

  std::uint32_t byte(std::uint64_t at) { return number(at, 1, false); }
  std::uint32_t little(std::uint64_t at, int bytes) { return number(at, bytes, false); }
  std::uint32_t big(std::uint64_t at, int bytes) { return number(at, bytes, true); }
  std::uint32_t number(std::uint64_t at, int bytes, bool big) {
    std::array<char, 4> text{};
    in_.clear();
    if (at > kMostPlace || !in_.seekg(static_cast<std::streamoff>(at)) || !in_.read(text.data(), bytes)) {
      ended_ = true;
      return 0;
    }
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i)
      value |= static_cast<std::uint32_t>(static_cast<unsigned char>(text[static_cast<std::size_t>(i)]))
               << 8 * (big ? bytes - 1 - i : i);
    return value;
  }
  /// As many of `most` bytes as there are.
  std::string text(std::uint64_t at, std::size_t most) {
    std::string all(most, '\0');
    in_.clear();
    if (!in_.seekg(static_cast<std::streamoff>(at))) return "";
    in_.read(all.data(), static_cast<std::streamsize>(most));
    all.resize(static_cast<std::size_t>(in_.gcount()));
    return all;
  }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  static constexpr std::uint64_t kMostPlace = std::uint64_t{1} << 62;
  std::ifstream in_;
  bool ended_ = false;
};

/// Calls `see(marker, place of what follows its length, bytes of that)` for the segments of a JPEG file up to its first
/// scan.
template <class See>
void each_jpeg_segment(FileBytes& file, See see) {
  std::uint64_t at = 2;
  while (!file.ended() && file.byte(at) == 0xFF) {
    const std::uint32_t marker = file.byte(at + 1);
    constexpr std::uint32_t kFill = 0xFF;
    constexpr std::uint32_t kScan = 0xDA;
    if (marker == kFill) {
      ++at;
      continue;
    }
    if (marker == kScan) return;
    const std::uint32_t length = file.big(at + 2, 2);
    if (length < 2) return;
    see(marker, at + 4, length - 2);
    at += 2 + length;
  }
}

/// The place of the first number behind the mark that a JPEG 2000 codestream begins with (SOC and SIZ); 0 if the file
/// has none.
inline std::uint64_t jpeg2000_size(FileBytes& file) {
  constexpr std::size_t kMostBoxes = std::size_t{1} << 20;
  const std::string begin = file.text(0, 12);
  const bool boxes = begin == std::string("\0\0\0\x0CjP  \r\n\x87\n", 12);
  if (!boxes && begin.compare(0, 4, "\xFF\x4F\xFF\x51") != 0) return 0;
  const std::size_t at = file.text(0, kMostBoxes).find("\xFF\x4F\xFF\x51");
  return at == std::string::npos ? 0 : at + 4;
}

}  // namespace kage
