// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
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
  /// The notes of a file beside its pixels, as words to compare: ("colour space", "sRGB").
  using Note = std::pair<std::string, std::string>;
  /// A note for which the format has no place: the words of OpenImageIO are a guess then, and the other file's is
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

/// A picture file whose lines come as they are asked for. All functions throw Error that names the file.
class PictureReader {
 public:
  virtual ~PictureReader() = default;
  PictureReader() = default;
  PictureReader(const PictureReader&) = delete;
  PictureReader& operator=(const PictureReader&) = delete;

  /// All but `data`.
  [[nodiscard]] const Picture& head() const { return head_; }
  /// Bytes of a line.
  [[nodiscard]] std::uint64_t line_bytes() const {
    return static_cast<std::uint64_t>(head_.width) * static_cast<std::uint64_t>(head_.pixel_bytes);
  }
  /// So many lines at a time are read best.
  [[nodiscard]] int step() const { return step_; }
  /// Bytes that the reader itself takes for the picture, beside those of a step.
  [[nodiscard]] std::uint64_t own_bytes() const { return own_bytes_; }

  /// Reads `count` lines from line `y` on. `y` is where the last call ended, and a multiple of step().
  virtual void read(int y, int count, std::byte* to) = 0;

 protected:
  Picture head_;
  int step_ = 1;
  std::uint64_t own_bytes_ = 0;
};

/// Opens a flat picture; alpha is taken as stored. `part` and `max_bytes` as load_picture() has them. Throws Error.
std::unique_ptr<PictureReader> open_picture(const std::filesystem::path& path, int part = -1,
                                            std::optional<std::uint64_t> max_bytes = {});

/// All of a reader's lines.
Picture whole_picture(PictureReader& reader);

/// Read a flat picture; alpha is taken as stored. Where a file holds several, as a multi-part EXR, `part` is the
/// number of one, from 0; without it (-1) such a file is refused. Throws Error, also where that takes more than
/// `max_bytes` of memory, or without it more than half of what there is.
Picture load_picture(const std::filesystem::path& path, int part = -1, std::optional<std::uint64_t> max_bytes = {});

/// The difference that makes two pictures incomparable (size, place, channels, types, notes), in words; "" if nothing
/// does.
std::string unlike(const Picture& a, const Picture& b);

}  // namespace kage
