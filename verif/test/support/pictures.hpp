// SPDX-License-Identifier: Apache-2.0
//
// Picture files for tests: of any type, with any values.
#pragma once

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "stimulus/random.hpp"

namespace kage::verif {

/// A folder of its own, gone with the object.
struct TempFolder {
  std::filesystem::path path;
  explicit TempFolder(const std::string& name)
      : path(std::filesystem::temp_directory_path() / ("kage-" + name + "-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path);
  }
  ~TempFolder() { std::filesystem::remove_all(path); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Writes values of `spec`'s own types.
inline std::filesystem::path write_picture(const std::filesystem::path& path, const OIIO::ImageSpec& spec,
                                           const void* values) {
  const auto output = OIIO::ImageOutput::create(path.extension().string().substr(1));
  if (!output || !output->open(path.string(), spec) || !output->write_image(OIIO::TypeDesc::UNKNOWN, values) ||
      !output->close())
    throw std::runtime_error(path.string() + ": the test cannot write it");
  return path;
}

/// An EXR of floats, `channels` a pixel.
inline std::filesystem::path write_floats(const std::filesystem::path& path, int width, int channels,
                                          const std::vector<float>& values) {
  const int height = static_cast<int>(values.size()) / width / channels;
  return write_picture(path, OIIO::ImageSpec(width, height, channels, OIIO::TypeDesc::FLOAT), values.data());
}

/// A float for which every sort is likely: zeros of both signs, the smallest, infinities, and neighbours of others.
inline float random_float(Random& random) {
  constexpr float kSpecial[] = {0.0F, -0.0F, 1.0F, -1.0F, 1e-45F, -1e-45F, 3.4e38F, -3.4e38F};
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (random.chance(0.1)) return random.chance(0.5) ? kInfinity : -kInfinity;
  float value = kSpecial[random.in(0, 7)];
  if (random.chance(0.3)) value = static_cast<float>(random.real(-2, 2));
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  if ((bits & 0x7FFFFFFF) < 0x7F7FFFFF && random.chance(0.5)) bits += static_cast<std::uint32_t>(random.in(0, 3));
  if ((bits & 0x7FFFFFFF) > 0x7F800000) bits = 0;
  std::memcpy(&value, &bits, sizeof bits);
  return value;
}

}  // namespace kage::verif
