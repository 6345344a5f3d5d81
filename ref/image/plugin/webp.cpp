// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/webp.hpp"

#include <fmt/format.h>
#include <webp/decode.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "kage/error.hpp"

namespace kage::picture_plugin {
namespace {

/// The bytes of the chunk of the RIFF file that has this name; nothing if there is none.
std::span<const unsigned char> chunk(std::span<const unsigned char> file, const char* name) {
  std::size_t at = 12;
  while (at + 8 <= file.size()) {
    const std::size_t size = file[at + 4] | static_cast<std::size_t>(file[at + 5]) << 8U |
                             static_cast<std::size_t>(file[at + 6]) << 16U |
                             static_cast<std::size_t>(file[at + 7]) << 24U;
    if (size > file.size() - at - 8) break;
    if (std::memcmp(&file[at], name, 4) == 0) return file.subspan(at + 8, size);
    at += 8 + size + size % 2;
  }
  return {};
}

/// Exif's number for how the picture is to be turned, of the directory that a chunk holds; 1 if it says nothing.
int exif_orientation(std::span<const unsigned char> exif) {
  if (exif.size() >= 6 && std::memcmp(exif.data(), "Exif\0\0", 6) == 0) exif = exif.subspan(6);
  const bool big = !exif.empty() && exif[0] == 'M';
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::size_t value = 0;
    if (at > exif.size() || bytes > exif.size() - at) return value;
    for (std::size_t i = 0; i < bytes; ++i) value |= std::size_t{exif[at + i]} << 8 * (big ? bytes - 1 - i : i);
    return value;
  };
  const std::size_t directory = number(4, 4);
  const std::size_t entries = number(directory, 2);
  for (std::size_t i = 0; i < entries; ++i) {
    constexpr std::size_t kOrientation = 0x0112;
    const std::size_t entry = directory + 2 + 12 * i;
    if (number(entry, 2) == kOrientation) return static_cast<int>(number(entry + 8, 2));
  }
  return 1;
}

}  // namespace

WebpHead webp_head(const std::filesystem::path& path, std::span<const unsigned char> file) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(file.data(), file.size(), &features) != VP8_STATUS_OK)
    throw Error(fmt::format("{}: the WebP file is damaged, or cut off", path.string()));
  if (features.has_animation != 0)
    throw Error(fmt::format("{}: is animated: only files of one picture are compared", path.string()));
  const auto profile = chunk(file, "ICCP");
  return {.width = features.width,
          .height = features.height,
          .alpha = features.has_alpha != 0,
          .orientation = exif_orientation(chunk(file, "EXIF")),
          .profile = std::string(profile.begin(), profile.end())};
}

void webp_pixels(const std::filesystem::path& path, std::span<const unsigned char> file, const WebpHead& head,
                 std::span<std::byte> to) {
  const auto pixels = static_cast<std::size_t>(head.width) * static_cast<std::size_t>(head.height);
  // With alpha always: the head's word for it is a hint, and pixels may have one that it does not tell.
  std::vector<std::uint8_t> own(head.alpha ? 0 : 4 * pixels);
  auto* const out = head.alpha ? reinterpret_cast<std::uint8_t*>(to.data()) : own.data();
  if (WebPDecodeRGBAInto(file.data(), file.size(), out, 4 * pixels, 4 * head.width) == nullptr)
    throw Error(fmt::format("{}: the WebP file is damaged, or cut off", path.string()));
  if (head.alpha) return;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (out[4 * i + 3] != 255)
      throw Error(fmt::format("{}: has alpha, and its head says that it has none", path.string()));
    std::memcpy(&to[3 * i], &out[4 * i], 3);
  }
}

}  // namespace kage::picture_plugin
