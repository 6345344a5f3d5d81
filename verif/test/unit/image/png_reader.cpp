// SPDX-License-Identifier: Apache-2.0
// kage's own reader of PNG against the picture plugin's, which is OpenImageIO's: every kind of pixel that PNG has,
// interlaced or not, with colours that are transparent; chunks that say what values mean; damaged files.
#include "image/png_reader.hpp"

#include <png.h>

#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../../support/catch.hpp"
#include "../../support/temp_directory.hpp"
#include "image/plugin/table.hpp"
#include "kage/error.hpp"
#include "stimulus/png_chunk.hpp"

namespace kage {
namespace {

struct Kind {
  int color;
  int bits;
};
constexpr Kind kKinds[] = {
    {PNG_COLOR_TYPE_GRAY, 1},        {PNG_COLOR_TYPE_GRAY, 2},       {PNG_COLOR_TYPE_GRAY, 4},
    {PNG_COLOR_TYPE_GRAY, 8},        {PNG_COLOR_TYPE_GRAY, 16},      {PNG_COLOR_TYPE_GRAY_ALPHA, 8},
    {PNG_COLOR_TYPE_GRAY_ALPHA, 16}, {PNG_COLOR_TYPE_RGB, 8},        {PNG_COLOR_TYPE_RGB, 16},
    {PNG_COLOR_TYPE_RGB_ALPHA, 8},   {PNG_COLOR_TYPE_RGB_ALPHA, 16}, {PNG_COLOR_TYPE_PALETTE, 1},
    {PNG_COLOR_TYPE_PALETTE, 2},     {PNG_COLOR_TYPE_PALETTE, 4},    {PNG_COLOR_TYPE_PALETTE, 8}};

/// A PNG of random values; libpng takes the rows as they are stored.
void write(const std::string& path, const Kind& kind, int width, int height, bool interlaced, bool transparent,
           unsigned seed) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  REQUIRE(file != nullptr);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (setjmp(png_jmpbuf(png)) != 0) FAIL("libpng cannot write " << path);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), kind.bits, kind.color,
               interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const auto next = [&seed] {
    seed = seed * 1664525U + 1013904223U;
    return static_cast<png_byte>(seed >> 24U);
  };
  if (kind.color == PNG_COLOR_TYPE_PALETTE) {
    std::vector<png_color> colors(std::size_t{1} << static_cast<unsigned>(kind.bits));
    for (png_color& c : colors) c = {next(), next(), next()};
    png_set_PLTE(png, info, colors.data(), static_cast<int>(colors.size()));
    const png_byte alphas[] = {0, 128};
    if (transparent) png_set_tRNS(png, info, alphas, 2, nullptr);
  } else if (transparent) {
    const png_color_16 color{0, 1, 1, 1, 1};
    png_set_tRNS(png, info, nullptr, 0, &color);
  }
  png_write_info(png, info);
  std::vector<png_byte> row(png_get_rowbytes(png, info) * static_cast<std::size_t>(height));
  for (png_byte& b : row) b = next();
  std::vector<png_bytep> rows;
  for (int y = 0; y < height; ++y)
    rows.push_back(row.data() + png_get_rowbytes(png, info) * static_cast<std::size_t>(y));
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

void hold(const std::string& path) {
  const auto own = open_png(path, -1);
  const auto other = plugin_table<PicturePlugin>().open(path, -1);
  const Picture a = whole_picture(*own);
  const Picture b = whole_picture(*other);
  CHECK(a.width == b.width);
  CHECK(a.height == b.height);
  CHECK(a.alpha == b.alpha);
  CHECK(a.pixel_bytes == b.pixel_bytes);
  CHECK(channel_names(a) == channel_names(b));
  CHECK(sample_names(a) == sample_names(b));
  CHECK(a.data == b.data);
  REQUIRE(a.notes.size() == b.notes.size());
  for (std::size_t i = 0; i < a.notes.size(); ++i) {
    CAPTURE(a.notes[i].first);
    CHECK(a.notes[i].first == b.notes[i].first);
    // Guesses of OpenImageIO, which differ between its versions.
    if (a.notes[i].first != "colour space" && a.notes[i].first != "gamma" && a.notes[i].first != "chromaticity")
      CHECK(a.notes[i].second == b.notes[i].second);
  }
}

TEST_CASE("every kind of PNG is read as the picture plugin reads it") {
  const test::TempDirectory temp;
  unsigned seed = 1;
  for (const Kind& kind : kKinds)
    for (const bool interlaced : {false, true})
      for (const bool transparent : {false, true})
        for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {64, 33}}) {
          if (transparent && (kind.color & PNG_COLOR_MASK_ALPHA) != 0) continue;
          CAPTURE(kind.color, kind.bits, interlaced, transparent, width, height);
          const std::string path = (temp.path() / "a.png").string();
          write(path, kind, width, height, interlaced, transparent, seed++);
          hold(path);
        }
}

TEST_CASE("chunks that say what values mean are told, and damaged ones do no harm") {
  using namespace std::string_literals;
  const test::TempDirectory temp;
  const std::string path = (temp.path() / "a.png").string();
  write(path, {PNG_COLOR_TYPE_RGB, 8}, 7, 5, false, false, 3);
  std::ifstream in(path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  constexpr std::size_t kHead = 33;  // the signature, and IHDR
  const auto with = [&](const std::string& chunks) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << whole.substr(0, kHead) + chunks + whole.substr(kHead);
  };
  const auto note = [&](const std::string& name) {
    for (const auto& [words, text] : whole_picture(*open_png(path, -1)).notes)
      if (words == name) return text;
    return "no such note"s;
  };
  const std::string big = "MM\0*\0\0\0\b\0\1\1\22\0\3\0\0\0\1\0\6\0\0\0\0\0\0"s;
  const std::string little = "II*\0\b\0\0\0\1\0\22\1\3\0\1\0\0\0\3\0\0\0\0\0\0\0"s;
  with(verif::png_chunk("gAMA", "\0\0\261\217"s) + verif::png_chunk("sBIT", "\5\6\5"s));
  CHECK(note("gAMA") == "45455");
  CHECK(note("number of significant bits") == "5 6 5");
  CHECK(note("orientation") == "1");
  hold(path);
  with(verif::png_chunk("sRGB", "\2"s));
  CHECK(note("rendering intent") == "2");
  for (const auto& [exif, orientation] : {std::pair{big, "6"}, {little, "3"}}) {
    with(verif::png_chunk("eXIf", exif));
    CHECK(note("orientation") == orientation);
    hold(path);
    for (std::size_t size = 0; size < exif.size(); ++size) {  // whatever is cut off
      with(verif::png_chunk("eXIf", exif.substr(0, size)));
      CHECK((note("orientation") == "1" || note("orientation") == orientation || note("orientation") == "0"));
    }
  }
  with(verif::png_chunk("eXIf", "MM\0*\377\377\377\377\0\1"s));  // entries at a place beyond the end
  CHECK(note("orientation") == "1");
  with(verif::png_chunk("acTL", "\0\0\0\2\0\0\0\0"s));
  CHECK_THROWS_WITH(open_png(path, -1), path + ": is animated: only files of one picture are compared");
  with(verif::png_chunk("iCCP", "name\0\0damaged"s));
  CHECK_THROWS_WITH(open_png(path, -1), path + ": has an ICC profile that is damaged");
}

TEST_CASE("a line that takes more memory than there may be is refused before it is made") {
  using namespace std::string_literals;
  const test::TempDirectory temp;
  const std::string path = (temp.path() / "wide.png").string();
  for (const std::string& interlaced : {"\0"s, "\1"s}) {
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        << "\x89PNG\r\n\x1a\n"s +
               verif::png_chunk("IHDR", "\x7f\xff\xff\xff\x7f\xff\xff\xff\x10\x06\0\0"s + interlaced) +
               verif::png_chunk("IDAT", "x"s) + verif::png_chunk("IEND", ""s);
    try {
      (void)open_png(path, -1, std::uint64_t{1} << 30);
      FAIL("lines of 17 GB are made");
    } catch (const Error& e) {
      CHECK(std::string(e.what()).rfind(path + ": its lines take", 0) == 0);
    }
  }
}

TEST_CASE("what is no whole PNG is refused by one line that names it") {
  const test::TempDirectory temp;
  const std::string path = (temp.path() / "a.png").string();
  write(path, {PNG_COLOR_TYPE_RGB, 8}, 64, 33, false, false, 5);
  std::ifstream in(path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  CHECK(is_png(path));
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{8}, std::size_t{20}, std::size_t{33},
                                 whole.size() / 2, whole.size() - 20}) {
    CAPTURE(size);
    std::ofstream(path, std::ios::binary | std::ios::trunc) << whole.substr(0, size);
    CHECK(is_png(path) == (size >= 8));
    try {
      (void)whole_picture(*open_png(path, -1));
      FAIL("a part of a file is read");
    } catch (const Error& e) {
      CHECK(std::string(e.what()).rfind(path + ": ", 0) == 0);
    }
  }
  CHECK_THROWS_AS(open_png((temp.path() / "none.png").string(), -1), Error);
  std::ofstream(path, std::ios::binary | std::ios::trunc) << whole;
  CHECK_THROWS_AS(open_png(path, 1), Error);
  CHECK_NOTHROW(whole_picture(*open_png(path, 0)));
}

}  // namespace
}  // namespace kage
