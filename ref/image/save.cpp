// SPDX-License-Identifier: Apache-2.0
#include "image/save.hpp"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <vector>

#include "kage/error.hpp"
#include "kage/paths.hpp"

namespace kage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string cause) {
  for (char& c : cause)
    if (c == '\n' || c == '\r') c = ' ';
  throw Error(fmt::format("{}: cannot be written{}{}", path.string(), cause.empty() ? "" : ": ", cause));
}

// More than zlib holds back.
constexpr std::size_t kBlock = std::size_t{256} << 10;

}  // namespace

struct ImageWriter::Data {
  Data(const std::filesystem::path& p, int w, int h, int c) : path(p), width(w), height(h), channels(c) {}

  std::filesystem::path path;
  int width;
  int height;
  int channels;
  int y = 0;
  std::unique_ptr<TempFile> file;
  std::unique_ptr<OIIO::ImageOutput> output;
};

ImageWriter::ImageWriter(const std::filesystem::path& path, int width, int height, int channels)
    : data_(std::make_unique<Data>(path, width, height, channels)) {
  const std::string extension = lower_extension(path);
  const bool exr = extension == ".exr";
  if (!exr && extension != ".png") throw Error(fmt::format("{}: pictures are written as .png or .exr", path.string()));
  if (width <= 0 || height <= 0 || (channels != 1 && channels != 3))
    throw Error(fmt::format("{}: a picture of {}x{} with {} channels cannot be written", path.string(), width, height,
                            channels));

  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code ec;
  if (!std::filesystem::is_directory(folder, ec)) fail(path, "no such folder");

  Data& d = *data_;
  d.file = std::make_unique<TempFile>(path);
  d.output = OIIO::ImageOutput::create(extension.substr(1));
  if (!d.output) fail(path, OIIO::geterror());
  OIIO::ImageSpec spec(width, height, channels, exr ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  if (channels == 1) spec.channelnames = {"Y"};
  if (!d.output->open(d.file->temp().string(), spec)) fail(path, d.output->geterror());
}

// libpng says "No IDATs written" on standard error where a file is closed before its first compressed block, so a
// picture that is given up gets as much noise as fills one. The file is closed before it is removed: members go in
// reverse order.
ImageWriter::~ImageWriter() {
  Data& d = *data_;
  if (!d.output) return;
  std::vector<std::uint8_t> noise(static_cast<std::size_t>(d.width) * static_cast<std::size_t>(d.channels));
  std::uint32_t state = 1;
  for (std::size_t written = 0; written < kBlock && d.y < d.height; written += noise.size()) {
    for (std::uint8_t& v : noise) v = static_cast<std::uint8_t>((state = state * 1664525U + 1013904223U) >> 24);
    if (!d.output->write_scanline(d.y++, 0, OIIO::TypeDesc::UINT8, noise.data())) return;
  }
}

void ImageWriter::line(std::span<const std::uint8_t> pixels) {
  Data& d = *data_;
  if (d.y >= d.height || pixels.size() != static_cast<std::size_t>(d.width) * static_cast<std::size_t>(d.channels))
    fail(d.path, fmt::format("line {} does not belong to a picture of {}x{}", d.y, d.width, d.height));
  if (!d.output->write_scanline(d.y++, 0, OIIO::TypeDesc::UINT8, pixels.data())) fail(d.path, d.output->geterror());
}

void ImageWriter::close() {
  Data& d = *data_;
  if (d.y != d.height) fail(d.path, fmt::format("{} of {} lines came", d.y, d.height));
  if (!d.output->close()) fail(d.path, d.output->geterror());
  d.output.reset();
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
