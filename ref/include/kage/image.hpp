// SPDX-License-Identifier: Apache-2.0

/// @file
/// Pictures: writing what a core drew, and reading it back; diff.hpp compares. Rows run from the top, pixels from the
/// left, channels of a pixel side by side. All functions throw kage::Error that names the file; none leaves a
/// half-written one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace kage {

/// A picture as a core draws it: 8 bits a channel, channels 1 (grey) or 3 (red, green, blue).
struct Image {
  int width = 0;                   ///< in pixels
  int height = 0;                  ///< in lines
  int channels = 0;                ///< 1 or 3; 0: there is no picture
  std::vector<std::uint8_t> data;  ///< height x width x channels

  Image() = default;

  /// A black picture.
  /// @param w width in pixels, >= 0
  /// @param h height in lines, >= 0
  /// @param c channels, 1 or 3
  Image(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

  /// Finds a pixel. Not checked.
  /// @param x 0 .. width - 1
  /// @param y 0 .. height - 1
  /// @return where in `data` its first channel is
  [[nodiscard]] std::size_t index(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
  bool operator==(const Image&) const = default;
};

/// Writes a picture as PNG, or as EXR (float, 255 is 1.0), by the extension; others are refused. The file appears under
/// its name only when it is whole.
/// @param path ends in .png or .exr
/// @param image what is written, of at least a pixel
void save_image(const std::filesystem::path& path, const Image& image);

/// Reads an 8-bit picture of 1 or 3 channels; others are refused.
/// @param path a file of any format that kage diff compares (docs/diff.md)
/// @return the picture, its values as they are in the file
Image load_image(const std::filesystem::path& path);

}  // namespace kage
