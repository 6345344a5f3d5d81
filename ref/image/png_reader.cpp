// SPDX-License-Identifier: Apache-2.0
#include "image/png_reader.hpp"

#include <fmt/format.h>
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "image/memory.hpp"
#include "image/png_chunks.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

constexpr std::size_t kSignature = 8;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File opened(const std::filesystem::path& path) {
  File file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::generic_category().message(errno)));
  return file;
}

/// libpng comes back from an error by longjmp(): the functions that call it hold nothing that has a destructor.
class PngReader : public PictureReader {
 public:
  PngReader(const std::filesystem::path& path, int part, std::optional<std::uint64_t> max_bytes)
      : name_(path.string()), file_(opened(path)) {
    if (part > 0) fail(fmt::format("holds 1 picture, and there is no number {}", part));
    const PngChunks chunks = read_png_chunks(path);
    if (chunks.animated) fail("is animated: only files of one picture are compared");
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    try {
      call([&] { begin(); });
      check_lines(max_bytes);
      call([&] { png_read_update_info(png_, info_); });
      describe(chunks);
    } catch (...) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw;
    }
  }
  ~PngReader() override { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  void read(int y, int count, std::byte* to) override {
    if (y == 0 && png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE)
      rows_.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows_[i] = reinterpret_cast<png_bytep>(to + i * static_cast<std::size_t>(line_bytes()));
    call([&] {
      if (!rows_.empty())
        png_read_image(png_, rows_.data());
      else
        for (int i = 0; i < count; ++i)
          png_read_row(png_, reinterpret_cast<png_bytep>(to + static_cast<std::size_t>(i) * line_bytes()), nullptr);
      if (y + count == head_.height) png_read_end(png_, nullptr);
    });
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const { throw Error(fmt::format("{}: {}", name_, cause)); }

  template <class Function>
  void call(Function function) {
    if (setjmp(png_jmpbuf(png_)) == 0) return function();
    fail(error_[0] == '\0' ? "cannot be read" : error_);
  }

  /// All before the first line, with the transformations that values need.
  void begin() {
    png_init_io(png_, file_.get());
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png_, info_);
    png_set_expand(png_);  // palettes, fewer bits than 8, and a transparent colour
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE) png_set_interlace_handling(png_);
  }

  /// libpng has two lines, and an interlaced picture takes an array of all its lines. With a width of 2^31 - 1 that is
  /// more than most machines have, in a file of some bytes.
  void check_lines(std::optional<std::uint64_t> max_bytes) {
    constexpr std::uint64_t kWidest = 8;  // bytes of a pixel: red, green, blue and alpha of 16 bits
    own_bytes_ = 2 * kWidest * png_get_image_width(png_, info_);
    if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE)
      own_bytes_ += sizeof(png_bytep) * png_get_image_height(png_, info_);
    check_memory(fmt::format("{}: its lines take", name_).c_str(), own_bytes_, max_bytes);
  }

  void describe(const PngChunks& chunks) {
    head_.width = static_cast<int>(png_get_image_width(png_, info_));
    head_.height = static_cast<int>(png_get_image_height(png_, info_));
    const bool wide = png_get_bit_depth(png_, info_) == 16;
    const int channels = png_get_channels(png_, info_);
    const char* const names = channels <= 2 ? "YA" : "RGBA";
    for (int c = 0; c < channels; ++c) {
      head_.channels.push_back({std::string(1, names[c]), wide ? Sample::kU16 : Sample::kU8, head_.pixel_bytes});
      head_.pixel_bytes += wide ? 2 : 1;
    }
    head_.alpha = channels % 2 == 0 ? channels - 1 : -1;
    const bool interlaced = png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE;
    constexpr std::uint64_t kStepBytes = std::uint64_t{1} << 20;
    step_ = interlaced ? head_.height
                       : static_cast<int>(
                             std::clamp<std::uint64_t>(kStepBytes / std::max<std::uint64_t>(line_bytes(), 1), 1, 1024));
    note(chunks, wide ? 16 : 8);
  }

  /// The notes that the picture plugin has of any file, in its order (image/plugin/read.cpp).
  void note(const PngChunks& chunks, int depth) {
    const int bits = chunks.bits == 0 ? depth : chunks.bits;
    std::string profile;
    if (png_charp name = nullptr; chunks.profile) {
      int compression = 0;
      png_bytep data = nullptr;
      png_uint_32 size = 0;
      if (png_get_iCCP(png_, info_, &name, &compression, &data, &size) == 0) fail("has an ICC profile that is damaged");
      profile = fmt::format("{} bytes, CRC-32 {:08x}", size, crc32_z(0, data, size));
    }
    auto& notes = head_.notes;
    notes = {{"display window", fmt::format("{}x{} at 0,0", head_.width, head_.height)},
             {"number of bits", fmt::format("{}", bits)},
             {"largest value", fmt::format("{}", (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1)},
             {"extra samples", Picture::kNoPlace},
             {"exposure", Picture::kNoPlace},
             {"BMP colour space", Picture::kNoPlace},
             {"photometric interpretation", Picture::kNoPlace},
             {"orientation", orientation()},
             {"chromaticity", chunks.chromaticities},
             {"white luminance", ""},
             {"colour space", chunks.intent.empty() ? "" : "sRGB"},
             {"gamma", ""},
             {"ICC profile", profile},
             {"gAMA", chunks.gamma},
             {"rendering intent", chunks.intent}};
    for (const auto& more : chunks.more) notes.push_back(more);
    notes.emplace_back("unassociated alpha", head_.alpha < 0 ? "" : "1");
  }

  /// The number that an Exif chunk before the picture has for the orientation, 1 without.
  std::string orientation() {
    png_uint_32 size = 0;
    png_bytep data = nullptr;
    if (png_get_eXIf_1(png_, info_, &size, &data) == 0 || size < 10) return "1";
    const bool big = data[0] == 'M';
    const auto number = [&](png_uint_32 at, png_uint_32 bytes) {
      std::uint32_t value = 0;
      for (png_uint_32 i = 0; i < bytes && at + bytes <= size; ++i)
        value |= static_cast<std::uint32_t>(data[at + i]) << 8 * (big ? bytes - 1 - i : i);
      return value;
    };
    constexpr std::uint32_t kOrientation = 0x112;
    const std::uint32_t at = number(4, 4);
    if (at > size) return "1";
    for (std::uint32_t entry = 0; entry < number(at, 2) && at + 2 + 12 * (entry + 1) <= size; ++entry)
      if (number(at + 2 + 12 * entry, 2) == kOrientation) return fmt::format("{}", number(at + 10 + 12 * entry, 2));
    return "1";
  }

  [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
    auto& self = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(self.error_, text, sizeof self.error_ - 1);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}

  std::string name_;
  File file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::vector<png_bytep> rows_;  // of an interlaced picture, which comes as a whole
  char error_[160] = {};
};

}  // namespace

bool is_png(const std::filesystem::path& path) {
  const File file = opened(path);
  png_byte begin[kSignature] = {};
  return std::fread(begin, 1, kSignature, file.get()) == kSignature && png_sig_cmp(begin, 0, kSignature) == 0;
}

std::unique_ptr<PictureReader> open_png(const std::filesystem::path& path, int part,
                                        std::optional<std::uint64_t> max_bytes) {
  return std::make_unique<PngReader>(path, part, max_bytes);
}

}  // namespace kage
