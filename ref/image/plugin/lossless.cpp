// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/lossless.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "image/file_bytes.hpp"
#include "kage/error.hpp"

namespace kage::picture_plugin {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& cause) {
  throw Error(fmt::format("{}: {}, which is not read without loss", path.string(), cause));
}

using Bytes = FileBytes;

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
  if ((file.byte(17) & 0xC0) != 0) return "has interleaved lines";
  if (type == 1 && (entry_bits == 32 || (entry_bits == 16 && alpha_bits != 0))) return "has a palette with alpha";
  if (type == 2 && (pixel_bits == 15 || pixel_bits == 16) && alpha_bits != 0) return "has one bit of alpha";
  if (type == 3 && pixel_bits == 16 && alpha_bits == 0) return "has grey of 16 bits";
  return "";
}

/// OpenImageIO takes bits of a pixel as the format has them without masks, and lines that are packed as they come.
std::string lost_of_bmp(Bytes& file) {
  constexpr std::uint32_t kOldHead = 12;
  constexpr std::uint32_t kMasks = 3;
  if (file.little(14, 4) == kOldHead) return "";
  const std::uint32_t compression = file.little(30, 4);
  if (compression == 0) return "";
  if (compression != kMasks) return "is compressed";
  constexpr std::array kUsual{0xFF0000U, 0xFF00U, 0xFFU};
  for (std::uint64_t i = 0; i < kUsual.size(); ++i)
    if (file.little(28, 2) != 32 || file.little(54 + 4 * i, 4) != kUsual[i]) return "has bits in places of its own";
  return "";
}

std::string lost_of_jpeg(Bytes& file) {
  std::string lost;
  each_jpeg_segment(file, [&](std::uint32_t marker, std::uint64_t at, std::uint32_t bytes) {
    constexpr std::uint32_t kFormats = 0xE2;  // APP2
    if (marker == kFormats && bytes > 4 && file.text(at, 4) == std::string("MPF\0", 4))
      lost = "holds pictures behind the first";
  });
  return lost;
}

/// OpenImageIO gives 16 bits of a value.
std::string lost_of_jpeg2000(Bytes& file) {
  const std::uint64_t at = jpeg2000_size(file);
  if (at == 0) return "";
  const std::uint32_t components = file.big(at + 36, 2);
  for (std::uint64_t c = 0; c < components && !file.ended(); ++c) {
    constexpr std::uint32_t kBits = 0x7F;  // one less
    if ((file.byte(at + 38 + 3 * c) & kBits) >= 16) return "has values of more than 16 bits";
  }
  return "";
}

/// An orientation behind the picture, which libpng's readers do not see when they begin.
std::string lost_of_png(Bytes& file) {
  bool behind = false;
  for (std::uint64_t at = 8; !file.ended();) {
    const std::string tag = file.text(at + 4, 4);
    if (tag == "IEND") break;
    if (tag == "eXIf" && behind) return "has its notes behind the picture (eXIf)";
    behind = behind || tag == "IDAT";
    at += std::uint64_t{12} + file.big(at, 4);
  }
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
  } else if (begin == "\x89PNG") {
    lost = lost_of_png(file);
  } else if (begin.compare(0, 2, "BM") == 0) {
    lost = lost_of_bmp(file);
  } else if (begin.compare(0, 3, "\xFF\xD8\xFF") == 0) {
    lost = lost_of_jpeg(file);
  } else if (jpeg2000_size(file) != 0) {
    lost = lost_of_jpeg2000(file);
  } else if (is_big_tiff(file)) {
    if (big_tiff_has_palette(file)) lost = "has a palette in a BigTIFF file";
  } else if (begin == std::string("II*\0", 4) || begin == std::string("MM\0*", 4)) {
    lost = lost_of_tiff(file);
  }
  if (!lost.empty()) refuse(path, lost);
}

void refuse_lossy_format(const std::filesystem::path& path, std::string_view format) {
  constexpr std::array kTried{"bmp", "dds", "dpx", "gif", "hdr",   "iff",  "jpeg", "jpeg2000", "openexr",
                              "png", "pnm", "rla", "sgi", "targa", "tiff", "webp", "zfile"};
  if (std::find(kTried.begin(), kTried.end(), format) == kTried.end())
    refuse(path, fmt::format("is of the format {}", format));
  if (format != "targa") return;  // which has no mark at its beginning, and is known by no name
  Bytes file(path);
  if (const std::string lost = lost_of_targa(file); !lost.empty()) refuse(path, lost);
}

}  // namespace kage::picture_plugin
