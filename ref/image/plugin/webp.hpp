// SPDX-License-Identifier: Apache-2.0
//
// WebP by its own library: OpenImageIO's reader multiplies colours by alpha.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace kage::picture_plugin {

struct WebpHead {
  int width = 0;
  int height = 0;
  bool alpha = false;
  int orientation = 1;  ///< Exif's number
  std::string profile;  ///< of chunk ICCP; empty if there is none
};

/// The head that a file's bytes begin with. Throws Error that names the file: it is damaged, or animated.
WebpHead webp_head(const std::filesystem::path& path, std::span<const unsigned char> file);

/// All pixels, red, green, blue and, if the file has it, alpha, as they are stored. Throws Error if they are damaged.
void webp_pixels(const std::filesystem::path& path, std::span<const unsigned char> file, const WebpHead& head,
                 std::span<std::byte> to);

}  // namespace kage::picture_plugin
