// SPDX-License-Identifier: Apache-2.0
#include "image/module/webp.hpp"

#include <fmt/format.h>
#include <webp/decode.h>

#include <cstring>

#include "kage/error.hpp"

namespace kage::picture_module {
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
          .profile = std::string(profile.begin(), profile.end())};
}

void webp_pixels(const std::filesystem::path& path, std::span<const unsigned char> file, const WebpHead& head,
                 std::span<std::byte> to) {
  auto* const out = reinterpret_cast<std::uint8_t*>(to.data());
  const int stride = head.width * (head.alpha ? 4 : 3);
  const auto decode = head.alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (decode(file.data(), file.size(), out, to.size(), stride) == nullptr)
    throw Error(fmt::format("{}: the WebP file is damaged, or cut off", path.string()));
}

}  // namespace kage::picture_module
