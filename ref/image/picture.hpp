// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace kage {

/// Type of a channel's value, as the file has it.
enum class Sample { kU8, kI8, kU16, kI16, kU32, kI32, kU64, kI64, kHalf, kFloat, kDouble };

/// Any picture file, its values untouched.
struct Picture {
  struct Channel {
    std::string name;
    Sample sample = Sample::kU8;
    std::size_t offset = 0;  ///< bytes from the pixel's first
  };
  /// What a file says beside its pixels, as words to compare: ("colour space", "sRGB").
  using Note = std::pair<std::string, std::string>;
  /// Of a note for which the format has no place: what OpenImageIO gives then is its guess, and the other file's is
  /// taken.
  static constexpr const char* kNoPlace = "no place";

  int x = 0;  ///< of the first pixel: files may have an origin
  int y = 0;
  int width = 0;
  int height = 0;
  std::vector<Channel> channels;
  int alpha = -1;               ///< which channel is alpha
  std::size_t pixel_bytes = 0;  ///< from a pixel to the next
  std::vector<Note> notes;      ///< always the same ones, in the same order; "" for what the file does not say
  std::vector<std::byte> data;

  [[nodiscard]] const std::byte* row(int at) const {
    return data.data() + static_cast<std::size_t>(at) * static_cast<std::size_t>(width) * pixel_bytes;
  }
};

/// Bytes of a value.
std::size_t size_of(Sample sample);

/// Half, float or double.
bool is_float(Sample sample);

/// Name for messages: "uint8", "half".
const char* name_of(Sample sample);

/// Names of the channels, by commas; a name that holds one is quoted.
std::string channel_names(const Picture& picture);

/// Types of the channels, by commas; one if all are alike.
std::string sample_names(const Picture& picture);

/// Read a flat picture; alpha is taken as stored. Of a file that holds several, as a multi-part EXR, `part` is the
/// number of one, from 0; without it (-1) such a file is refused. Throws Error.
Picture load_picture(const std::filesystem::path& path, int part = -1);

/// What makes two pictures incomparable (size, place, channels, types, notes), in words; "" if nothing does.
std::string unlike(const Picture& a, const Picture& b);

}  // namespace kage
