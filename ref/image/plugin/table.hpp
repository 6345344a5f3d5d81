// SPDX-License-Identifier: Apache-2.0
//
// The picture plugin: what needs OpenImageIO.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "image/encoder.hpp"
#include "image/picture.hpp"
#include "plugin/plugin.hpp"

namespace kage {

struct PicturePlugin : PluginHead {
  static constexpr const char* kPlugin = "kage_pictures";
  static constexpr const char* kWhatFor =
      "pictures other than PNG are read, and EXR is written, with it (OpenImageIO; Debian: libopenimageio-dev)";
  /// Some 450 MiB of libraries (verif/test/cli/little_memory.sh; Debian 12's take 30 less than Debian 13's), and
  /// OpenImageIO's threads and OpenEXR's, one per processor.
  static std::size_t room() { return (440U + 16U * std::thread::hardware_concurrency()) << 20U; }

  /// As open_picture().
  std::unique_ptr<PictureReader> (*open)(const std::filesystem::path& path, int part);
  /// As encode_exr().
  std::unique_ptr<ImageEncoder> (*encode_exr)(OutputFile& out, const std::string& name, int width, int height,
                                              int channels);
  /// Pixels that Yee's measure tells apart, of two pictures of three linear floats a pixel; nothing if it fails.
  std::optional<std::uint64_t> (*yee)(int width, int height, float* a, float* b);
};

// The parts of the plugin, in its own files.
namespace picture_plugin {
std::unique_ptr<PictureReader> open(const std::filesystem::path& path, int part);
std::unique_ptr<ImageEncoder> encode_exr(OutputFile& out, const std::string& name, int width, int height, int channels);
std::optional<std::uint64_t> yee(int width, int height, float* a, float* b);
}  // namespace picture_plugin

}  // namespace kage
