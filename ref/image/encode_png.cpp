// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <exception>
#include <new>
#include <utility>

#include "image/encoder.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

/// libpng is C: an exception may not pass through it. An exception of the file is kept until libpng has returned, and
/// nothing more is written from then on.
class PngEncoder : public ImageEncoder {
 public:
  PngEncoder(OutputFile& out, std::string name, int width, int height, int channels)
      : out_(out), name_(std::move(name)) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
    try {
      call([&] {
        png_set_write_fn(png_, this, on_write, on_flush);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                     channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        // Flat areas and their edges, which these pictures are made of, pack best as they are.
        png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
        // A third of the instructions of the usual level 6, for files about half as large again.
        png_set_compression_level(png_, 3);
        png_write_info(png_, info_);
      });
    } catch (...) {
      png_destroy_write_struct(&png_, &info_);
      throw;
    }
  }
  ~PngEncoder() override { png_destroy_write_struct(&png_, &info_); }
  PngEncoder(const PngEncoder&) = delete;
  PngEncoder& operator=(const PngEncoder&) = delete;

  void line(std::span<const std::uint8_t> pixels) override {
    call([&] { png_write_row(png_, pixels.data()); });
  }

  void finish() override {
    call([&] { png_write_end(png_, nullptr); });
  }

 private:
  /// Calls libpng, which comes back by longjmp() after an error of its own: `function` may hold nothing that has a
  /// destructor.
  template <class Function>
  void call(Function function) {
    if (setjmp(png_jmpbuf(png_)) == 0) function();
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    if (!error_.empty()) throw Error(fmt::format("{}: cannot be written: {}", name_, error_));
  }

  static PngEncoder& self(void* pointer) { return *static_cast<PngEncoder*>(pointer); }

  static void on_write(png_structp png, png_bytep data, png_size_t size) {
    PngEncoder& encoder = self(png_get_io_ptr(png));
    if (encoder.failed_) return;
    try {
      encoder.out_.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    } catch (...) {
      encoder.failed_ = true;
      encoder.thrown_ = std::current_exception();
    }
  }
  static void on_flush(png_structp) {}

  [[noreturn]] static void on_error(png_structp png, png_const_charp text) {
    try {
      self(png_get_error_ptr(png)).error_ = text;
    } catch (...) {
      self(png_get_error_ptr(png)).thrown_ = std::current_exception();
    }
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}

  OutputFile& out_;
  std::string name_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  bool failed_ = false;
  std::exception_ptr thrown_;
  std::string error_;
};

}  // namespace

std::unique_ptr<ImageEncoder> encode_png(OutputFile& out, const std::string& name, int width, int height,
                                         int channels) {
  return std::make_unique<PngEncoder>(out, name, width, height, channels);
}

}  // namespace kage
