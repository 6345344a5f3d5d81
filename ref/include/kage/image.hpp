// SPDX-License-Identifier: Apache-2.0
//
// Pictures: writing what a core drew, and comparing picture files. Rows run from the top, pixels from the left,
// channels of a pixel side by side. All functions throw kage::Error that names the file; none leaves a half-written
// one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
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

/// Where two pictures are told apart, and how far.
///
/// The distance of two channel values is counted in LSB: steps of the file's own pixel type. For integers that is |a -
/// b|; for half, float and double it is the number of representable values between them (-0 and +0 are one step apart),
/// so that distance 0 means equal bits. It is symmetric and obeys the triangle inequality. Nothing is near a NaN,
/// another NaN included.
struct DiffOptions {
  std::uint64_t lsb = 0;                    ///< a pixel is different if a channel is further apart than this
  std::optional<std::uint64_t> max_pixels;  ///< so many different pixels are still "same"
  std::optional<double>
      max_percent;  ///< likewise, of all pixels; with both, both must hold; with neither, none may differ
};

struct DiffResult {
  struct Position {
    int x = 0;
    int y = 0;
    int channel = 0;
  };
  bool same = false;
  std::string reason;  ///< why not, in words; empty if same
  int width = 0;  ///< 0 if the pictures are unlike in size, channels or pixel type; then nothing below is set either
  int height = 0;
  int channels = 0;
  std::uint64_t different_pixels = 0;
  std::uint64_t nan_pixels = 0;   ///< pixels with a NaN on either side: different, and never tolerated
  std::uint64_t max_lsb = 0;      ///< largest distance of all, whatever the options
  std::optional<Position> first;  ///< first different pixel, line by line, and its first different channel
};

/// Compare two picture files of any type OpenImageIO reads. Pictures unlike in size, channels or pixel type are
/// different. Where `heat` is given it becomes the difference picture: the first one dimmed, red where they differ.
DiffResult diff_files(const std::filesystem::path& a, const std::filesystem::path& b, const DiffOptions& options = {},
                      Image* heat = nullptr);

/// The same for pictures in memory.
DiffResult diff_images(const Image& a, const Image& b, const DiffOptions& options = {}, Image* heat = nullptr);

}  // namespace kage
