// SPDX-License-Identifier: Apache-2.0
#include "image/save.hpp"

#include <fmt/format.h>

#include <optional>

#include "file/extension.hpp"
#include "image/encoder.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& cause) {
  throw Error(fmt::format("{}: cannot be written: {}", path.string(), cause));
}

}  // namespace

struct ImageWriter::Data {
  std::filesystem::path path;
  int width = 0;
  int height = 0;
  int channels = 0;
  int y = 0;
  std::unique_ptr<TempFile> file;
  std::optional<OutputFile> out;
  std::unique_ptr<ImageEncoder> encoder;  // it goes before what it writes to: members go in reverse order
};

ImageWriter::ImageWriter(const std::filesystem::path& path, int width, int height, int channels)
    : data_(std::make_unique<Data>()) {
  const std::string extension = lower_extension(path);
  const bool exr = extension == ".exr";
  if (!exr && extension != ".png") throw Error(fmt::format("{}: pictures are written as .png or .exr", path.string()));
  if (width <= 0 || height <= 0 || (channels != 1 && channels != 3))
    throw Error(fmt::format("{}: a picture of {}x{} with {} channels cannot be written", path.string(), width, height,
                            channels));
  Data& d = *data_;
  d.path = path;
  d.width = width;
  d.height = height;
  d.channels = channels;
  d.file = std::make_unique<TempFile>(path);
  d.out.emplace(d.file->temp(), path.string());
  d.encoder = (exr ? encode_exr : encode_png)(*d.out, path.string(), width, height, channels);
}

ImageWriter::~ImageWriter() = default;

void ImageWriter::line(std::span<const std::uint8_t> pixels) {
  Data& d = *data_;
  if (d.y >= d.height || pixels.size() != static_cast<std::size_t>(d.width) * static_cast<std::size_t>(d.channels))
    fail(d.path, fmt::format("line {} does not belong to a picture of {}x{}", d.y, d.width, d.height));
  d.encoder->line(pixels);
  ++d.y;
}

void ImageWriter::close() {
  Data& d = *data_;
  if (d.y != d.height) fail(d.path, fmt::format("{} of {} lines came", d.y, d.height));
  d.encoder->finish();
  d.encoder.reset();
  d.out->close();
}

const std::filesystem::path& ImageWriter::temp() const { return data_->file->temp(); }

void ImageWriter::hand_over(TempFiles& files) { files.add(std::move(data_->file)); }

void save_image(TempFiles& files, const std::filesystem::path& path, const Image& image) {
  ImageWriter writer(path, image.width, image.height, image.channels);
  const std::size_t line = image.index(0, 1);
  for (int y = 0; y < image.height; ++y)
    writer.line(std::span(image.data).subspan(static_cast<std::size_t>(y) * line, line));
  writer.close();
  writer.hand_over(files);
}

void save_image(const std::filesystem::path& path, const Image& image) {
  TempFiles file;
  save_image(file, path, image);
  file.commit();
}

}  // namespace kage
