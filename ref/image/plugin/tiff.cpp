// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/tiff.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tiffio.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kage/error.hpp"

namespace kage::picture_plugin {
namespace {

int silent(TIFF*, void*, const char*, const char*, va_list) { return 1; }

struct Closer {
  void operator()(TIFF* file) const { TIFFClose(file); }
};
using Handle = std::unique_ptr<TIFF, Closer>;

[[noreturn]] void refuse_tiff(const std::filesystem::path& path, const std::string& cause) {
  throw Error(fmt::format("{}: {}", path.string(), cause));
}

Handle open_tiff(const std::filesystem::path& path, int part) {
  const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                             TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), silent, nullptr);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), silent, nullptr);
  Handle file(TIFFOpenExt(path.c_str(), "r", options.get()));
  if (!file || TIFFSetDirectory(file.get(), static_cast<tdir_t>(part)) != 1)
    refuse_tiff(path, "the TIFF file is damaged");
  return file;
}

std::uint16_t number(TIFF* file, std::uint32_t tag, std::uint16_t otherwise) {
  std::uint16_t value = otherwise;
  return TIFFGetFieldDefaulted(file, tag, &value) == 1 ? value : otherwise;
}

std::span<const std::uint16_t> extra_samples(TIFF* file) {
  std::uint16_t count = 0;
  const std::uint16_t* kinds = nullptr;
  if (TIFFGetField(file, TIFFTAG_EXTRASAMPLES, &count, &kinds) != 1) return {};
  return {kinds, count};
}

/// The part of the directory that OpenImageIO would lose; "" if it loses nothing.
std::string lost(TIFF* file) {
  const std::uint16_t compression = number(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (TIFFIsCODECConfigured(compression) != 1 || compression == COMPRESSION_JBIG)
    return fmt::format("is compressed in the way {}, which is not read", compression);
  std::uint32_t height = 0;
  TIFFGetField(file, TIFFTAG_IMAGELENGTH, &height);
  if (height == 1 && number(file, TIFFTAG_BITSPERSAMPLE, 1) == 64)  // a line alone comes as zeros
    return "has one line of values of 64 bits, which is not read without loss";
  if (number(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_PALETTE &&
      number(file, TIFFTAG_SAMPLESPERPIXEL, 1) != 1)
    return "has a palette with alpha, which is not read without loss";
  std::uint16_t within = 0;
  const std::uint64_t* places = nullptr;
  if (TIFFGetField(file, TIFFTAG_SUBIFD, &within, &places) == 1 && within > 0)
    return "has pictures within its picture, which are not read";
  return "";
}

/// The first line that cannot be decoded; -1 if all can.
std::int64_t bad_line(TIFF* file) {
  std::uint32_t height = 0;
  TIFFGetField(file, TIFFTAG_IMAGELENGTH, &height);
  if (number(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_JPEG)
    TIFFSetField(file, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  const bool planes = number(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;
  const std::uint16_t samples = planes ? number(file, TIFFTAG_SAMPLESPERPIXEL, 1) : 1;
  std::vector<std::byte> line(static_cast<std::size_t>(TIFFScanlineSize64(file)));
  for (std::uint16_t s = 0; s < samples; ++s)
    for (std::uint32_t y = 0; y < height; ++y)
      if (TIFFReadScanline(file, line.data(), y, s) != 1) return y;
  return -1;
}

}  // namespace

std::string check_tiff_head(const std::filesystem::path& path, int part) {
  const Handle file = open_tiff(path, part);
  if (const std::string cause = lost(file.get()); !cause.empty()) refuse_tiff(path, cause);
  return fmt::format("{}", fmt::join(extra_samples(file.get()), " "));
}

void check_tiff_lines(const std::filesystem::path& path, int part) {
  const Handle file = open_tiff(path, part);
  if (TIFFIsTiled(file.get()) != 0) return;  // OpenImageIO refuses those that are damaged
  for (std::uint32_t strip = 0; strip < TIFFNumberOfStrips(file.get()); ++strip)
    if (TIFFGetStrileByteCount(file.get(), strip) == 0) refuse_tiff(path, fmt::format("strip {} is left out", strip));
  if (const std::int64_t y = bad_line(file.get()); y >= 0)
    refuse_tiff(path, fmt::format("line {} cannot be decoded: it is damaged, or cut off", y));
}

}  // namespace kage::picture_plugin
