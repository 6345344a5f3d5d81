// SPDX-License-Identifier: Apache-2.0
#include "image/opening.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "image/file_bytes.hpp"

namespace kage {
namespace {

std::uint64_t of_gif(FileBytes& file) {
  constexpr std::uint64_t kCanvases = 2;  // the one that is drawn, and the one before it
  return std::uint64_t{4} * kCanvases * file.little(6, 2) * file.little(8, 2);
}

/// Progressive files, and others of several scans, keep the coefficients of all of them.
std::uint64_t of_jpeg(FileBytes& file) {
  std::uint64_t bytes = 0;
  std::uint32_t components = 0;
  bool keeps = false;
  each_jpeg_segment(file, [&](std::uint32_t marker, std::uint64_t at, std::uint32_t) {
    constexpr std::uint32_t kScan = 0xDA;
    constexpr std::uint32_t kNoFrames[] = {0xC4, 0xC8, 0xCC};  // tables, and one that nothing uses
    constexpr std::uint64_t kCoefficient = 2;
    if (marker == kScan) {
      keeps = keeps || file.byte(at) < components;
    } else if (marker >= 0xC0 && marker <= 0xCF && std::ranges::find(kNoFrames, marker) == std::end(kNoFrames)) {
      components = file.byte(at + 5);
      bytes = kCoefficient * file.big(at + 1, 2) * file.big(at + 3, 2) * components;
      keeps = (marker & 3U) == 2;
    }
  });
  return keeps ? bytes : 0;
}

std::uint64_t of_jpeg2000(FileBytes& file) {
  const std::uint64_t at = jpeg2000_size(file);
  if (at == 0) return 0;
  const auto extent = [&](std::uint64_t from) -> std::uint64_t {
    const std::uint64_t end = file.big(from, 4);
    const std::uint64_t begin = file.big(from + 8, 4);
    return end > begin ? end - begin : 0;
  };
  constexpr std::uint64_t kOfValue = 12;  // as a number of 32 bits, twice for a tile, and as it comes out
  const std::uint64_t pixels = extent(at + 4) * extent(at + 8);
  const std::uint64_t components = file.big(at + 36, 2);
  constexpr std::uint64_t kMost = std::uint64_t{1} << 44;
  return pixels > kMost ? kMost : pixels * components * kOfValue;
}

}  // namespace

std::uint64_t bytes_of_opening(const std::filesystem::path& path) {
  FileBytes file(path);
  const std::string begin = file.text(0, 4);
  if (begin == "GIF8") return of_gif(file);
  if (begin.compare(0, 3, "\xFF\xD8\xFF") == 0) return of_jpeg(file);
  return of_jpeg2000(file);
}

}  // namespace kage
