// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace kage {

/// Bytes of a file by their place. Behind the end all are 0, and ended() says that one was asked for.
class FileBytes {
 public:
  explicit FileBytes(const std::filesystem::path& path) : in_(path, std::ios::binary | std::ios::ate) {
    size_ = in_ ? static_cast<std::uint64_t>(in_.tellg()) : 0;
  }

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
  std::string text(std::uint64_t at, std::uint64_t most) {
    if (at >= size_) return "";
    std::string all(std::min<std::uint64_t>(most, size_ - at), '\0');
    in_.clear();
    if (!in_.seekg(static_cast<std::streamoff>(at))) return "";
    in_.read(all.data(), static_cast<std::streamsize>(all.size()));
    all.resize(static_cast<std::size_t>(in_.gcount()));
    return all;
  }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  static constexpr std::uint64_t kMostPlace = std::uint64_t{1} << 62;
  std::ifstream in_;
  std::uint64_t size_ = 0;
  bool ended_ = false;
};

/// Calls `see(marker, place of what follows its length, bytes of that)` for the segments of a JPEG file, the head of
/// its first scan the last.
template <class See>
void each_jpeg_segment(FileBytes& file, See see) {
  constexpr std::uint32_t kFill = 0xFF;
  constexpr std::uint32_t kScan = 0xDA;
  std::uint64_t at = 2;
  while (!file.ended() && file.byte(at) == 0xFF) {
    const std::uint32_t marker = file.byte(at + 1);
    if (marker == kFill) {
      ++at;
      continue;
    }
    const std::uint32_t length = file.big(at + 2, 2);
    if (length < 2) return;
    see(marker, at + 4, length - 2);
    if (marker == kScan) return;
    at += 2 + length;
  }
}

/// The place of the first number behind the mark that a JPEG 2000 codestream begins with (SOC and SIZ); 0 if the file
/// has none.
inline std::uint64_t jpeg2000_size(FileBytes& file) {
  const std::string mark = "\xFF\x4F\xFF\x51";
  if (file.text(0, 4) == mark) return 4;
  if (file.text(0, 12) != std::string("\0\0\0\x0CjP  \r\n\x87\n", 12)) return 0;
  for (std::uint64_t at = 0; !file.ended();) {
    std::uint64_t bytes = file.big(at, 4);
    const bool is_long = bytes == 1;
    const std::uint64_t head = is_long ? 16 : 8;
    if (is_long) bytes = std::uint64_t{file.big(at + 8, 4)} << 32U | file.big(at + 12, 4);
    if (file.text(at + 4, 4) == "jp2c") return file.text(at + head, 4) == mark ? at + head + 4 : 0;
    if (bytes < head) return 0;  // 0: it reaches to the end
    at += bytes;
  }
  return 0;
}

}  // namespace kage
