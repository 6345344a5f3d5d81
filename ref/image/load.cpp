// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "image/picture.hpp"
#include "kage/error.hpp"
#include "kage/image.hpp"

namespace kage {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& cause) {
  // OpenImageIO's messages may repeat the name and take several lines.
  std::string text = cause;
  for (const std::string& prefix : {path.string() + ": ", "\"" + path.string() + "\": "})
    if (const auto at = text.find(prefix); at != std::string::npos) text.erase(at, prefix.size());
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  throw Error(fmt::format("{}: {}", path.string(), text.empty() ? "cannot be read" : text));
}

Sample sample_of(const OIIO::TypeDesc& type, const std::filesystem::path& path) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return Sample::kU8;
    case OIIO::TypeDesc::INT8:
      return Sample::kI8;
    case OIIO::TypeDesc::UINT16:
      return Sample::kU16;
    case OIIO::TypeDesc::INT16:
      return Sample::kI16;
    case OIIO::TypeDesc::UINT32:
      return Sample::kU32;
    case OIIO::TypeDesc::INT32:
      return Sample::kI32;
    case OIIO::TypeDesc::UINT64:
      return Sample::kU64;
    case OIIO::TypeDesc::INT64:
      return Sample::kI64;
    case OIIO::TypeDesc::HALF:
      return Sample::kHalf;
    case OIIO::TypeDesc::FLOAT:
      return Sample::kFloat;
    case OIIO::TypeDesc::DOUBLE:
      return Sample::kDouble;
    default:
      fail(path, fmt::format("pixels of type {} cannot be compared", type.c_str()));
  }
}

}  // namespace

std::size_t size_of(Sample sample) {
  switch (sample) {
    case Sample::kU8:
    case Sample::kI8:
      return 1;
    case Sample::kU16:
    case Sample::kI16:
    case Sample::kHalf:
      return 2;
    case Sample::kU32:
    case Sample::kI32:
    case Sample::kFloat:
      return 4;
    case Sample::kU64:
    case Sample::kI64:
    case Sample::kDouble:
      return 8;
  }
  return 0;
}

const char* name_of(Sample sample) {
  static constexpr const char* kNames[] = {"uint8",  "int8",  "uint16", "int16", "uint32", "int32",
                                           "uint64", "int64", "half",   "float", "double"};
  return kNames[static_cast<std::size_t>(sample)];
}

Picture load_picture(const std::filesystem::path& path) {
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (!std::filesystem::exists(status)) fail(path, "no such file");
  if (std::filesystem::is_directory(status)) fail(path, "is a directory");

  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(path.string(), &hints);
  if (!input) fail(path, OIIO::geterror());
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.deep || spec.depth > 1) fail(path, "is not a flat picture");

  Picture picture;
  picture.x = spec.x;
  picture.y = spec.y;
  picture.width = spec.width;
  picture.height = spec.height;
  picture.channels = spec.nchannels;
  picture.channel_names = fmt::format("{}", fmt::join(spec.channelnames, ","));
  picture.sample = sample_of(spec.format, path);
  constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 33;
  const std::uint64_t bytes = spec.image_bytes(false);
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || bytes > kMaxBytes)
    fail(path, fmt::format("size {}x{} with {} channels is refused", spec.width, spec.height, spec.nchannels));
  const OIIO::TypeDesc format = spec.format;
  try {
    picture.data.resize(bytes);
  } catch (const std::bad_alloc&) {
    fail(path, fmt::format("size {}x{} does not fit into memory", spec.width, spec.height));
  }
  if (!input->read_image(0, 0, 0, picture.channels, format, picture.data.data())) fail(path, input->geterror());
  if (input->seek_subimage(1, 0)) fail(path, "holds several pictures: only files of one are compared");
  (void)input->geterror();
  return picture;
}

Image load_image(const std::filesystem::path& path) {
  const Picture picture = load_picture(path);
  if (picture.sample != Sample::kU8 || (picture.channels != 1 && picture.channels != 3))
    fail(path, fmt::format("has {} channels of {}, not 1 or 3 of uint8", picture.channels, name_of(picture.sample)));
  Image image(picture.width, picture.height, picture.channels);
  std::memcpy(image.data.data(), picture.data.data(), image.data.size());
  return image;
}

}  // namespace kage
