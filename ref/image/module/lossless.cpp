// SPDX-License-Identifier: Apache-2.0
#include "image/module/lossless.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include "kage/error.hpp"

namespace kage::picture_module {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& cause) {
  throw Error(fmt::format("{}: {}, which is not read without loss", path.string(), cause));
}

/// Bytes of a file by their place. Behind the end all are 0.
class Bytes {
 public:
  explicit Bytes(const std::filesystem::path& path) : in_(path, std::ios::binary) {}

  std::uint32_t byte(std::uint64_t at) { return number(at, 1, false); }
  std::uint32_t little(std::uint64_t at, int bytes) { return number(at, bytes, false); }
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
  std::string text(std::uint64_t at, int bytes) {
    std::string all;
    for (int i = 0; i < bytes; ++i) all += static_cast<char>(byte(at + static_cast<std::uint64_t>(i)));
    return all;
  }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  static constexpr std::uint64_t kMostPlace = std::uint64_t{1} << 62;
  std::ifstream in_;
  bool ended_ = false;
};

/// Whether a picture of the file has a colour that is transparent: OpenImageIO makes it black.
bool gif_is_transparent(Bytes& file) {
  const auto colours = [&](std::uint64_t flags_at) -> std::uint64_t {
    const std::uint32_t flags = file.byte(flags_at);
    return (flags & 0x80) != 0 ? 3ULL << ((flags & 7) + 1) : 0;
  };
  std::uint64_t at = 13 + colours(10);
  while (!file.ended()) {
    const std::uint32_t kind = file.byte(at);
    if (kind == 0x21 && file.byte(at + 1) == 0xF9 && (file.byte(at + 3) & 1) != 0) return true;
    if (kind == 0x21)
      at += 2;
    else if (kind == 0x2C)
      at += 11 + colours(at + 9);
    else
      return false;
    while (!file.ended() && file.byte(at) != 0) at += file.byte(at) + 1;
    ++at;
  }
  return false;
}

/// The part of a Truevision file that does not come through; "" if all does.
std::string lost_of_targa(Bytes& file) {
  const std::uint32_t type = file.byte(2) & 7;
  const std::uint32_t alpha_bits = file.byte(17) & 15;
  const std::uint32_t entry_bits = file.byte(7);
  const std::uint32_t pixel_bits = file.byte(16);
  if (type == 1 && (entry_bits == 32 || (entry_bits == 16 && alpha_bits != 0))) return "has a palette with alpha";
  if (type == 2 && pixel_bits == 16 && alpha_bits != 0) return "has one bit of alpha";
  if (type == 3 && pixel_bits == 16 && alpha_bits == 0) return "has grey of 16 bits";
  return "";
}

std::string lost_of_dds(Bytes& file) {
  constexpr std::uint32_t kFourCc = 4;
  if ((file.little(80, 4) & kFourCc) != 0) {
    const std::string kind = file.text(84, 4);
    return kind == "DXT1" || kind == "DXT3" || kind == "DXT5" ? ""
                                                              : "is compressed otherwise than by DXT1, DXT3 or DXT5";
  }
  for (int i = 0; i < 4; ++i)
    if (std::popcount(file.little(92 + 4 * static_cast<std::uint64_t>(i), 4)) > 8)
      return "has values of more than 8 bits";
  return "";
}

/// The palette of a directory of a TIFF file has 16 bits a value, of which OpenImageIO gives eight.
bool tiff_palette_is_deep(Bytes& file, std::uint64_t directory, bool big, std::uint64_t& next) {
  const std::uint32_t entries = file.number(directory, 2, big);
  bool deep = false;
  for (std::uint32_t i = 0; i < entries && !file.ended(); ++i) {
    const std::uint64_t entry = directory + 2 + 12ULL * i;
    constexpr std::uint32_t kColorMap = 320;
    if (file.number(entry, 2, big) != kColorMap) continue;
    const std::uint32_t count = std::min(file.number(entry + 4, 4, big), 3U << 16U);
    const std::uint64_t map = file.number(entry + 8, 4, big);
    for (std::uint32_t k = 0; k < count && !file.ended(); ++k)
      deep = deep || file.number(map + 2ULL * k, 2, big) % 257 != 0;
  }
  next = file.number(directory + 2 + 12ULL * entries, 4, big);
  return deep;
}

std::string lost_of_tiff(Bytes& file) {
  const bool big = file.byte(0) == 'M';
  if (file.number(2, 2, big) != 42) return "";  // BigTIFF, whose palettes OpenImageIO's writers do not make
  std::uint64_t directory = file.number(4, 4, big);
  constexpr int kMostDirectories = 1000;  // they may go round
  for (int i = 0; i < kMostDirectories && directory != 0 && !file.ended(); ++i)
    if (tiff_palette_is_deep(file, directory, big, directory)) return "has a palette of 16 bits";
  return "";
}

/// The same for BigTIFF: it has no limit that a look at it would keep, so a palette there is refused.
bool is_big_tiff(Bytes& file) {
  const std::string begin = file.text(0, 4);
  return begin == std::string("II+\0", 4) || begin == std::string("MM\0+", 4);
}

bool big_tiff_has_palette(Bytes& file) {
  const bool big = file.byte(0) == 'M';
  const std::uint64_t high = file.number(big ? 8 : 12, 4, big);
  const std::uint64_t directory = high << 32U | file.number(big ? 12 : 8, 4, big);
  const std::uint32_t entries = file.number(directory + (big ? 4 : 0), 4, big);
  constexpr std::uint32_t kColorMap = 320;
  for (std::uint32_t i = 0; i < entries && !file.ended(); ++i)
    if (file.number(directory + 8 + 20ULL * i, 2, big) == kColorMap) return true;
  return false;
}

}  // namespace

void refuse_lossy_file(const std::filesystem::path& path) {
  Bytes file(path);
  const std::string begin = file.text(0, 4);
  std::string lost;
  if (begin == "GIF8") {
    if (gif_is_transparent(file)) lost = "has a transparent colour";
  } else if (begin == "DDS ") {
    lost = lost_of_dds(file);
  } else if (is_big_tiff(file)) {
    if (big_tiff_has_palette(file)) lost = "has a palette in a BigTIFF file";
  } else if (begin == std::string("II*\0", 4) || begin == std::string("MM\0*", 4)) {
    lost = lost_of_tiff(file);
  }
  if (!lost.empty()) refuse(path, lost);
}

void refuse_lossy_format(const std::filesystem::path& path, std::string_view format) {
  constexpr std::array kTried{"bmp",     "dds", "dpx", "fits", "gif", "hdr",   "iff",  "jpeg", "jpeg2000",
                              "openexr", "png", "pnm", "rla",  "sgi", "targa", "tiff", "webp", "zfile"};
  if (std::find(kTried.begin(), kTried.end(), format) == kTried.end())
    refuse(path, fmt::format("is of the format {}", format));
  if (format != "targa") return;  // which has no mark at its beginning, and is known by no name
  Bytes file(path);
  if (const std::string lost = lost_of_targa(file); !lost.empty()) refuse(path, lost);
}

}  // namespace kage::picture_module
