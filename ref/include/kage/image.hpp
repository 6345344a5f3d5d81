// SPDX-License-Identifier: Apache-2.0
//
// Pictures: writing what a core drew, and reading it back; diff.hpp compares. Rows run from the top, pixels from the
// left, channels of a pixel side by side. All functions throw kage::Error that names the file; none leaves a
// half-written one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace kage {

/// What a core draws: 8 bits a channel, 1 (grey) or 3 (red, green, blue).
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> data;

  Image() = default;
  Image(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

  [[nodiscard]] std::size_t index(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
  bool operator==(const Image&) const = default;
};

/// Write `image` as PNG, or as EXR (float, 255 is 1.0), by the extension of `path`. Other extensions are refused. The
/// file appears under its name only when it is whole.
void save_image(const std::filesystem::path& path, const Image& image);

/// Read an 8-bit picture of 1 or 3 channels.
Image load_image(const std::filesystem::path& path);

}  // namespace kage
