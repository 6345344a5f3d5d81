// SPDX-License-Identifier: Apache-2.0
// Same means equal bits, in every format that is read: two files that differ in one value, under whatever alpha, come
// out different, or are refused in one line. Files are written by OpenImageIO, by libwebp, or byte by byte.
#include <webp/encode.h>
#include <zlib.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kage/diff.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

using namespace kage;
using namespace kage::verif;

namespace {

namespace fs = std::filesystem;
using Values = std::vector<std::uint16_t>;

constexpr int kWidth = 8;
constexpr int kHeight = 4;

/// The verdict on two files: "same", "different", or the refusal.
std::string said(const fs::path& a, const fs::path& b) {
  try {
    return diff_files(a, b).same ? "same" : "different";
  } catch (const Error& e) {
    return e.what();
  }
}

/// The file's bytes must be what differs, or the case tries nothing.
void check_pair(const fs::path& a, const fs::path& b, const std::string& refusal = "") {
  CAPTURE(a.filename().string(), b.filename().string());
  REQUIRE(bytes_of(a) != bytes_of(b));
  if (refusal.empty()) {
    CHECK(said(a, b) == "different");
    CHECK(said(b, a) == "different");
    CHECK(said(a, a) == "same");
    CHECK(said(b, b) == "same");
  } else {
    CHECK(said(a, b) == a.string() + ": " + refusal + ", which is not read without loss");
  }
  // Under a name that says nothing of the format: what it is found to be may be another reader's, or nobody's.
  const TempFolder folder("lossless-names");
  const fs::path a_named = folder.path / "a.dat";
  const fs::path b_named = folder.path / "b.dat";
  fs::copy_file(a, a_named);
  fs::copy_file(b, b_named);
  CHECK(said(a_named, b_named) != "same");
}

std::string little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i);
  return text;
}
std::string big(std::uint64_t value, int bytes) {
  const std::string text = little(value, bytes);
  return {text.rbegin(), text.rend()};
}
std::string bytes(std::initializer_list<int> list) {
  std::string text;
  for (const int b : list) text += static_cast<char>(b);
  return text;
}

fs::path put(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

/// A picture of all sorts of values, with alpha 0, the least, some and whole in turn.
Values picture(int channels, int most) {
  Values values;
  for (int i = 0; i < kWidth * kHeight; ++i)
    for (int c = 0; c < channels; ++c) {
      const int alphas[] = {0, 1, most / 2, most};
      const bool alpha = c == channels - 1 && channels % 2 == 0;
      const unsigned mixed = static_cast<unsigned>(i) * 2654435761U + 977U * static_cast<unsigned>(c);
      const int value = alpha ? alphas[i % 4] : static_cast<int>(mixed % static_cast<unsigned>(most + 1));
      values.push_back(static_cast<std::uint16_t>(value));
    }
  return values;
}

/// A format as OpenImageIO writes it.
struct Written {
  const char* extension;
  int channels;
  OIIO::TypeDesc type;
};

fs::path write_values(const fs::path& path, const Written& w, const Values& values) {
  OIIO::ImageSpec spec(kWidth, kHeight, w.channels, w.type);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("DateTime", "2026:01:01 00:00:00");
  if (w.type == OIIO::TypeDesc::UINT16) return write_picture(path, spec, values.data());
  if (w.type == OIIO::TypeDesc::UINT8) {
    const std::vector<std::uint8_t> narrow(values.begin(), values.end());
    return write_picture(path, spec, narrow.data());
  }
  if (w.type == OIIO::TypeDesc::HALF) {  // the values are patterns, of finite numbers
    Values halves = values;
    for (std::uint16_t& v : halves) v &= 0xBBFF;
    return write_picture(path, spec, halves.data());
  }
  std::vector<float> floats;
  for (const std::uint16_t v : values) floats.push_back(static_cast<float>(v) / 256.0F);
  return write_picture(path, spec, floats.data());
}

std::string png_chunk(const std::string& tag, const std::string& data) {
  const std::string all = tag + data;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(all.data()), static_cast<uInt>(all.size()));
  return big(data.size(), 4) + all + big(crc, 4);
}

/// Four pixels of 8 bits with a palette, whose alphas are those of a tRNS chunk.
std::string png_with_palette(const std::string& palette, const std::string& alphas) {
  const std::string line = bytes({0, 0, 1, 2, 3});
  std::string packed(64, '\0');
  auto size = static_cast<uLongf>(packed.size());
  REQUIRE(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(line.data()),
                   static_cast<uLong>(line.size())) == Z_OK);
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", big(4, 4) + big(1, 4) + bytes({8, 3, 0, 0, 0})) +
         png_chunk("PLTE", palette) + png_chunk("tRNS", alphas) + png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

/// Four pixels that a palette of four colours names, the first one transparent or none.
std::string gif(const std::string& palette, bool transparent) {
  const std::string control = bytes({0x21, 0xF9, 4, transparent ? 1 : 0, 0, 0, 0, 0});
  // Codes of three bits: clear, 0, 1, clear, 2, 3, end.
  unsigned bits = 0;
  int count = 0;
  std::string packed;
  for (const unsigned code : {4U, 0U, 1U, 4U, 2U, 3U, 5U}) {
    bits |= code << count;
    for (count += 3; count >= 8; count -= 8, bits >>= 8) packed += static_cast<char>(bits);
  }
  packed += static_cast<char>(bits);
  return "GIF89a" + little(4, 2) + little(1, 2) + bytes({0x81, 0, 0}) + palette + control + bytes({0x2C}) +
         little(0, 4) + little(4, 2) + little(1, 2) + bytes({0, 2, static_cast<int>(packed.size())}) + packed +
         bytes({0, 0x3B});
}

std::string targa(int type, int bits, int alpha_bits, const std::string& pixels, int entry_bits = 0,
                  const std::string& palette = "") {
  const int entries = entry_bits == 0 ? 0 : static_cast<int>(palette.size()) / ((entry_bits + 7) / 8);
  return bytes({0, entries != 0 ? 1 : 0, type}) + little(0, 2) + little(static_cast<unsigned>(entries), 2) +
         bytes({entry_bits}) + little(0, 4) + little(4, 2) + little(1, 2) + bytes({bits, 0x20 | alpha_bits}) + palette +
         pixels;
}

std::string bmp(int bits, const std::string& pixels, const std::string& palette = "") {
  const std::size_t begin = 14 + 40 + palette.size();
  return "BM" + little(begin + pixels.size(), 4) + little(0, 4) + little(begin, 4) + little(40, 4) + little(4, 4) +
         little(1, 4) + little(1, 2) + little(static_cast<unsigned>(bits), 2) + little(0, 4) +
         little(pixels.size(), 4) + little(2835, 4) + little(2835, 4) + little(palette.size() / 4, 4) + little(0, 4) +
         palette + pixels;
}

std::string dds(unsigned flags, const std::string& kind, int bits, const std::vector<std::uint32_t>& masks,
                const std::string& pixels, int width = 4) {
  std::string m;
  for (const std::uint32_t mask : masks) m += little(mask, 4);
  return "DDS " + little(124, 4) + little(0x1007, 4) + little(1, 4) + little(static_cast<unsigned>(width), 4) +
         little(pixels.size(), 4) + little(0, 8) + std::string(44, '\0') + little(32, 4) + little(flags, 4) + kind +
         little(static_cast<unsigned>(bits), 4) + m + little(0x1000, 4) + std::string(16, '\0') + pixels;
}

/// A TIFF of four pixels with a palette of 16 bits a value, of which `second` is the red of the second colour.
std::string tiff_with_palette(bool is_big, unsigned second) {
  const auto number = [&](std::uint64_t v, int n) { return is_big ? big(v, n) : little(v, n); };
  constexpr unsigned kEntries = 10;
  constexpr unsigned kPixels = 8 + 2 + 12 * kEntries + 4;
  std::string text = (is_big ? "MM" : "II") + number(42, 2) + number(8, 4) + number(kEntries, 2);
  const auto entry = [&](unsigned tag, bool is_long, unsigned count, unsigned value) {
    text += number(tag, 2) + number(is_long ? 4 : 3, 2) + number(count, 4);
    text += is_long || count > 2 ? number(value, 4) : number(value, 2) + number(0, 2);
  };
  entry(256, false, 1, 4);
  entry(257, false, 1, 1);
  entry(258, false, 1, 8);
  entry(259, false, 1, 1);
  entry(262, false, 1, 3);
  entry(273, true, 1, kPixels);
  entry(277, false, 1, 1);
  entry(278, false, 1, 1);
  entry(279, true, 1, 4);
  entry(320, false, 3 * 256, kPixels + 4);
  text += number(0, 4) + bytes({0, 1, 2, 3});
  for (unsigned i = 0; i < 3 * 256; ++i) text += number(i == 1 ? second : i % 256 * 257, 2);
  return text;
}

fs::path write_webp(const fs::path& path, const std::vector<std::uint8_t>& rgba, int lossless) {
  WebPConfig config;
  WebPPicture picture;
  REQUIRE(WebPConfigInit(&config));
  REQUIRE(WebPPictureInit(&picture));
  config.lossless = lossless;
  config.exact = 1;  // colours under alpha 0 stay
  WebPMemoryWriter memory;
  WebPMemoryWriterInit(&memory);
  picture.use_argb = lossless;
  picture.width = kWidth;
  picture.height = kHeight;
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &memory;
  REQUIRE(WebPPictureImportRGBA(&picture, rgba.data(), 4 * kWidth));
  REQUIRE(WebPEncode(&config, &picture));
  put(path, {reinterpret_cast<const char*>(memory.mem), memory.size});
  WebPMemoryWriterClear(&memory);
  WebPPictureFree(&picture);
  return path;
}

}  // namespace

TEST_CASE("files that differ in one value are different, in every format that OpenImageIO writes") {
  const TempFolder folder("lossless");
  const auto u8 = OIIO::TypeDesc::UINT8;
  const auto u16 = OIIO::TypeDesc::UINT16;
  const Written formats[] = {{"png", 4, u8},
                             {"png", 2, u8},
                             {"png", 3, u8},
                             {"png", 1, u8},
                             {"png", 4, u16},
                             {"png", 2, u16},
                             {"png", 3, u16},
                             {"png", 1, u16},
                             {"tif", 4, u8},
                             {"tif", 2, u8},
                             {"tif", 4, u16},
                             {"tif", 1, u16},
                             {"tif", 4, OIIO::TypeDesc::FLOAT},
                             {"exr", 4, OIIO::TypeDesc::FLOAT},
                             {"exr", 4, OIIO::TypeDesc::HALF},
                             {"tga", 4, u8},
                             {"tga", 3, u8},
                             {"tga", 1, u8},
                             {"bmp", 4, u8},
                             {"bmp", 3, u8},
                             {"sgi", 4, u8},
                             {"sgi", 4, u16},
                             {"sgi", 2, u8},
                             {"dpx", 4, u8},
                             {"dpx", 4, u16},
                             {"dpx", 3, u16},
                             {"rla", 4, u8},
                             {"rla", 4, u16},
                             {"iff", 4, u8},
                             {"iff", 4, u16},
                             {"ppm", 3, u8},
                             {"ppm", 3, u16},
                             {"pgm", 1, u8},
                             {"pgm", 1, u16},
                             {"zfile", 1, OIIO::TypeDesc::FLOAT}};
  for (const Written& w : formats) {
    const int most = w.type == u8 ? 255 : 65535;
    Values values = picture(w.channels, most);
    const std::string name = std::string(w.extension) + std::to_string(w.channels) + w.type.c_str();
    const fs::path a = write_values(folder.path / ("a-" + name + "." + w.extension), w, values);
    // One bit of each channel, at each sort of alpha.
    for (int pixel = 0; pixel < 4; ++pixel)
      for (int c = 0; c < w.channels; ++c) {
        Values changed = values;
        changed[static_cast<std::size_t>(pixel) * static_cast<std::size_t>(w.channels) + static_cast<std::size_t>(c)] ^=
            1;
        CAPTURE(name, pixel, c);
        check_pair(a, write_values(folder.path / ("b-" + name + "." + w.extension), w, changed));
      }
  }
}

TEST_CASE("a PFM's floats are compared bit by bit") {
  const TempFolder folder("lossless-pfm");
  const auto pfm = [](std::uint32_t bits) {
    return "PF\n2 1\n-1.0\n" + little(bits, 4) + little(std::bit_cast<std::uint32_t>(0.25F), 4) + std::string(16, '\0');
  };
  for (int bit = 0; bit < 32; ++bit)
    if (bit != 30)  // of 1.5 it makes a NaN, which is never the same
      check_pair(put(folder.path / "a.pfm", pfm(std::bit_cast<std::uint32_t>(1.5F))),
                 put(folder.path / "b.pfm", pfm(std::bit_cast<std::uint32_t>(1.5F) ^ 1U << bit)));
}

TEST_CASE("WebP holds colours under every alpha") {
  const TempFolder folder("lossless-webp");
  const Values values = picture(4, 255);
  const std::vector<std::uint8_t> rgba(values.begin(), values.end());
  const fs::path a = write_webp(folder.path / "a.webp", rgba, 1);
  for (std::size_t i = 0; i < 16; ++i) {
    std::vector<std::uint8_t> changed = rgba;
    changed[i] ^= 1;
    CAPTURE(i);
    check_pair(a, write_webp(folder.path / "b.webp", changed, 1));
  }
  // Opaque, and with loss: what is decoded is compared.
  std::vector<std::uint8_t> opaque = rgba;
  for (std::size_t i = 3; i < opaque.size(); i += 4) opaque[i] = 255;
  std::vector<std::uint8_t> dark(opaque.size(), 0);
  for (const int lossless : {0, 1})
    check_pair(write_webp(folder.path / "c.webp", opaque, lossless),
               write_webp(folder.path / "d.webp", dark, lossless));
  std::string cut = bytes_of(a);
  cut.resize(cut.size() - 8);
  CHECK_THAT(said(put(folder.path / "cut.webp", cut), a), Catch::Matchers::ContainsSubstring("cut.webp: "));
}

TEST_CASE("a palette's colours are compared, under every alpha, or it is refused") {
  const TempFolder folder("lossless-palette");
  const auto file = [&](const std::string& name, const std::string& content) {
    return put(folder.path / name, content);
  };
  const std::string palette = bytes({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  for (int i = 0; i < 12; ++i) {
    std::string other = palette;
    other[static_cast<std::size_t>(i)] ^= 1;
    CAPTURE(i);
    check_pair(file("a.png", png_with_palette(palette, bytes({0, 1, 128}))),
               file("b.png", png_with_palette(other, bytes({0, 1, 128}))));
    check_pair(file("a.gif", gif(palette, false)), file("b.gif", gif(other, false)));
    check_pair(file("a.gif", gif(palette, true)), file("b.gif", gif(other, true)), "has a transparent colour");
    check_pair(file("a.tga", targa(1, 8, 0, bytes({0, 1, 2, 3}), 24, palette)),
               file("b.tga", targa(1, 8, 0, bytes({0, 1, 2, 3}), 24, other)));
    check_pair(file("a.tga", targa(1, 8, 8, bytes({0, 1, 2, 0}), 32, palette)),
               file("b.tga", targa(1, 8, 8, bytes({0, 1, 2, 0}), 32, other)), "has a palette with alpha");
  }
  check_pair(file("a.png", png_with_palette(palette, bytes({0, 1, 128}))),
             file("b.png", png_with_palette(palette, bytes({1, 1, 128}))));
  const std::string wide = bytes({1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 0});
  std::string other = wide;
  other[8] ^= 1;
  check_pair(file("a.bmp", bmp(8, bytes({0, 1, 2, 3}), wide)), file("b.bmp", bmp(8, bytes({0, 1, 2, 3}), other)));
  check_pair(file("a.tga", targa(1, 8, 1, bytes({0, 1, 2, 3}), 16, little(0x0400'0020'0001, 8))),
             file("b.tga", targa(1, 8, 1, bytes({0, 1, 2, 3}), 16, little(0x0400'0020'8001, 8))),
             "has a palette with alpha");
  for (const bool is_big : {false, true}) {
    check_pair(file("a.tif", tiff_with_palette(is_big, 257)), file("b.tif", tiff_with_palette(is_big, 514)));
    check_pair(file("a.tif", tiff_with_palette(is_big, 258)), file("b.tif", tiff_with_palette(is_big, 257)),
               "has a palette of 16 bits");
  }
}

TEST_CASE("values of less or more than eight bits are compared, or refused") {
  const TempFolder folder("lossless-bits");
  const auto file = [&](const std::string& name, const std::string& content) {
    return put(folder.path / name, content);
  };
  const auto words = [](std::initializer_list<unsigned> list) {
    std::string text;
    for (const unsigned w : list) text += little(w, 2);
    return text;
  };
  for (unsigned bit = 1; bit < 0x8000; bit <<= 1) {
    CAPTURE(bit);
    check_pair(file("a.tga", targa(2, 16, 0, words({0x1234, 1, 2, 3}))),
               file("b.tga", targa(2, 16, 0, words({0x1234 ^ bit, 1, 2, 3}))));
    check_pair(file("a.bmp", bmp(16, words({0x1234, 1, 2, 3}))),
               file("b.bmp", bmp(16, words({0x1234 ^ bit, 1, 2, 3}))));
    for (const std::vector<std::uint32_t>& masks : {std::vector<std::uint32_t>{0xF800, 0x7E0, 0x1F, 0},
                                                    {0xF00, 0xF0, 0xF, 0xF000},
                                                    {0x7C00, 0x3E0, 0x1F, 0x8000}})
      check_pair(
          file("a.dds", dds(masks[3] != 0 ? 0x41 : 0x40, little(0, 4), 16, masks, words({0x1234, 1, 2, 3}))),
          file("b.dds", dds(masks[3] != 0 ? 0x41 : 0x40, little(0, 4), 16, masks, words({0x1234 ^ bit, 1, 2, 3}))));
  }
  check_pair(file("a.tga", targa(2, 16, 1, words({0x1234, 1, 2, 3}))),
             file("b.tga", targa(2, 16, 1, words({0x9234, 1, 2, 3}))), "has one bit of alpha");
  check_pair(file("a.tga", targa(3, 16, 0, words({0x1234, 1, 2, 3}))),
             file("b.tga", targa(3, 16, 0, words({0x1235, 1, 2, 3}))), "has grey of 16 bits");
  check_pair(file("a.tga", targa(3, 16, 8, words({0x1234, 1, 2, 3}))),
             file("b.tga", targa(3, 16, 8, words({0x0034, 1, 2, 3}))));
  const std::vector<std::uint32_t> ten{0x3FF00000, 0xFFC00, 0x3FF, 0xC0000000};
  check_pair(file("a.dds", dds(0x41, little(0, 4), 32, ten, little(0x12345678, 4), 1)),
             file("b.dds", dds(0x41, little(0, 4), 32, ten, little(0x12345679, 4), 1)),
             "has values of more than 8 bits");
  const std::vector<std::uint32_t> eight{0xFF0000, 0xFF00, 0xFF, 0xFF000000};
  for (unsigned bit = 0; bit < 32; ++bit)
    check_pair(file("a.dds", dds(0x41, little(0, 4), 32, eight, little(0x00345678, 4), 1)),
               file("b.dds", dds(0x41, little(0, 4), 32, eight, little(0x00345678 ^ 1U << bit, 4), 1)));
  const std::string block = little(0, 8) + words({0x1234, 0xF7FF}) + little(0xE4E4E4E4, 4);
  const std::string blacker = little(0, 8) + words({0x1234, 0xF7FE}) + little(0xE4E4E4E4, 4);
  for (const char* kind : {"DXT3", "DXT5"})
    check_pair(file("a.dds", dds(4, kind, 0, {0, 0, 0, 0}, block)),
               file("b.dds", dds(4, kind, 0, {0, 0, 0, 0}, blacker)));
  for (const char* kind : {"DXT2", "DXT4", "ATI2", "DX10"})  // OpenImageIO ends by a signal at the first two
    check_pair(file("a.dds", dds(4, kind, 0, {0, 0, 0, 0}, block)),
               file("b.dds", dds(4, kind, 0, {0, 0, 0, 0}, blacker)),
               "is compressed otherwise than by DXT1, DXT3 or DXT5");
}

/// A TIFF of one strip in front of which its directory stands, so that the strip can be cut off; `more` are entries
/// behind the usual ones, of a number each.
std::string tiff(unsigned width, unsigned height, unsigned samples, unsigned photometric, unsigned compression,
                 const std::string& strip, const std::vector<std::pair<unsigned, unsigned>>& more = {}) {
  std::vector<std::pair<unsigned, unsigned>> entries{
      {256, width},       {257, height},      {258, 8},
      {259, compression}, {262, photometric}, {273, 0},
      {277, samples},     {278, height},      {279, width * height * samples}};
  entries.insert(entries.end(), more.begin(), more.end());
  entries[5].second = static_cast<unsigned>(8 + 2 + 12 * entries.size() + 4);
  std::string text = "II" + little(42, 2) + little(8, 4) + little(entries.size(), 2);
  for (const auto& [tag, value] : entries) {
    // A tag with a value for each sample has equal values, as many as fit into an entry.
    const unsigned count = tag == 320 ? 3 * 256 : tag == 258 && samples == 2 ? 2 : 1;
    text += little(tag, 2) + little(tag == 330 ? 4 : 3, 2) + little(count, 4) +
            little(count == 2 ? value | value << 16U : value, 4);
  }
  return text + little(0, 4) + strip;
}

TEST_CASE("a TIFF's lines are decoded, or it is refused") {
  const TempFolder folder("lossless-tiff");
  const auto file = [&](const std::string& name, const std::string& content) {
    return put(folder.path / name, content);
  };
  const auto refused = [&](const std::string& content, const std::string& cause) {
    CAPTURE(cause);
    const fs::path a = file("a.tif", content);
    CHECK(said(a, a) == a.string() + ": " + cause);
  };
  const std::string sound(64, '\x37');
  check_pair(file("a.tif", tiff(16, 4, 1, 1, 1, sound)), file("b.tif", tiff(16, 4, 1, 1, 1, std::string(64, '\x36'))));
  for (const unsigned compression : {5U, 8U, 32946U})  // LZW, and zlib by two numbers
    refused(tiff(16, 4, 1, 1, compression, std::string(64, '\x55')),
            "line 0 cannot be decoded: it is damaged, or cut off");
  refused(tiff(16, 4, 1, 1, 34933, sound), "is compressed in the way 34933, which is not read");
  refused(tiff(16, 4, 1, 1, 1, sound.substr(1)), "line 0 cannot be decoded: it is damaged, or cut off");
  constexpr unsigned kColours = 8 + 2 + 12 * 11 + 4 + 64;
  refused(tiff(8, 4, 2, 3, 1, sound + std::string(std::size_t{6} * 256, '\3'), {{320, kColours}, {338, 2}}),
          "has a palette with alpha, which is not read without loss");
  refused(tiff(16, 4, 1, 1, 1, sound, {{330, 8}}), "has pictures within its picture, which are not read");
  const fs::path a = file("a.tif", tiff(8, 4, 2, 1, 1, sound, {{338, 0}}));
  CHECK(said(a, file("b.tif", tiff(8, 4, 2, 1, 1, sound, {{338, 2}}))) == "different");
  // A line of doubles alone came as zeros, and so did the last one of 129.
  const auto doubles = [&](const std::string& name, int height, double last) {
    std::vector<double> values(static_cast<std::size_t>(height) * 1024, 1e300);
    values.back() = last;
    return write_picture(folder.path / name, OIIO::ImageSpec(1024, height, 1, OIIO::TypeDesc::DOUBLE), values.data());
  };
  for (const int height : {2, 128, 129, 257}) {
    CAPTURE(height);
    check_pair(doubles("a.tif", height, 1e300), doubles("b.tif", height, 2e300));
  }
  const fs::path one = doubles("c.tif", 1, 0);
  CHECK(said(one, one) == one.string() + ": has one line of values of 64 bits, which is not read without loss");
}

TEST_CASE("a Netpbm file's values are compared with their largest, and none is beyond it") {
  const TempFolder folder("lossless-pnm");
  const auto file = [&](const std::string& name, const std::string& content) {
    return put(folder.path / name, content);
  };
  check_pair(file("a.pgm", "P5\n1 1\n200\n\x65"), file("b.pgm", "P5\n1 1\n254\n\x80"));
  check_pair(file("a.pgm", "P5\n1 1\n15\n\x0F"), file("b.pgm", "P5\n1 1\n255\n\xFF"));
  check_pair(file("a.pbm", "P1\n2 1\n1 0\n"), file("b.pgm", "P2\n2 1\n255\n0 255\n"));
  check_pair(file("a.ppm", "P3\n1 1\n1023\n1 2 3\n"), file("b.ppm", "P3 # and\n1 1\n1023\n1 2 4"));
  check_pair(file("a.pgm", "P5\n2 1\n1023\n" + big(1022, 2) + big(0, 2)),
             file("b.pgm", "P5\n2 1\n1023\n" + big(1023, 2) + big(0, 2)));
  for (const std::string& sound :
       {std::string("P5\n1 1\n255\na\n"), std::string("P2\n1 1\n255\n7\n\x1A"), std::string("Pf\n1 1\n+1.0\nabcd")}) {
    const fs::path a = file("a.pnm", sound);
    CHECK(said(a, a) == "same");
  }
  const std::pair<std::string, std::string> refused[] = {
      {std::string("P5\n2 1\n100\n\x00\x65", 13), "has the value 101, and its largest is 100"},
      {"P5\n1 1\n1000\n" + big(1001, 2), "has the value 1001, and its largest is 1000"},
      {"P2\n1 1\n100\n300\n", "\"300\" is not a value from 0 to 100"},
      {"P2\n1 1\n255\n-1\n", "\"-1\" is not a value from 0 to 255"},
      {"P2\n1 1\n255\n25.7\n", "\"25.7\" is not a value from 0 to 255"},
      {"P2\n1 1\n65536\n1\n", "\"65536\" is not a largest value from 0 to 65535"},
      {"P2\n1 1\n0\n0\n", "its largest value is 0"},
      {"P5\n2147483647 2147483647\n255\n", "\"2147483647\" is not a width from 0 to 16777216"},
      {"P2\n2 1\n255\n1", "ends where a value is to be"},
      {"P2\n1 1\n255\n1 2", "has words behind its picture, which are not read"},
      {"P1\n2 1\n1 2\n", "has a value that is neither 0 nor 1"},
      {"P5\n2 2\n255\nabc", "is cut off"},
      {"P5\n2 1\n255\nabP5\n2 1\n255\nac", "has bytes behind its picture, which are not read"},
      {"Pf\n1 1\n-0.1\nabcd", "its values are to be multiplied by -0.1, which is not read without loss"},
      {"Pf\n1 1\n1e\nabcd", "\"1e\" is no factor"}};
  for (const auto& [content, cause] : refused) {
    const fs::path a = file("a.pnm", content);
    CHECK(said(a, a) == a.string() + ": " + cause);
  }
}

TEST_CASE("what a file says of its values beside them is compared, or refused") {
  const TempFolder folder("lossless-heads");
  const auto file = [&](const std::string& name, const std::string& content) {
    return put(folder.path / name, content);
  };
  const auto refused = [&](const std::string& name, const std::string& content, const std::string& cause) {
    const fs::path a = file(name, content);
    CHECK(said(a, a) == a.string() + ": " + cause + ", which is not read without loss");
  };
  // Bits of a pixel in places of their own, and lines that are packed.
  const auto masked = [](int bits, const std::vector<std::uint32_t>& masks, const std::string& pixels) {
    std::string text = bmp(bits, pixels);
    std::string all;
    for (const std::uint32_t m : masks) all += little(m, 4);
    text.replace(30, 4, little(3, 4));
    text.replace(10, 4, little(14 + 40 + all.size(), 4));
    return text.insert(54, all);
  };
  check_pair(file("a.bmp", masked(32, {0xFF0000, 0xFF00, 0xFF}, little(0x112233, 4) + std::string(12, '\0'))),
             file("b.bmp", masked(32, {0xFF0000, 0xFF00, 0xFF}, little(0x332211, 4) + std::string(12, '\0'))));
  refused("a.bmp", masked(32, {0xFF, 0xFF00, 0xFF0000}, std::string(16, '\1')), "has bits in places of its own");
  refused("a.bmp", masked(16, {0xF800, 0x7E0, 0x1F}, std::string(8, '\1')), "has bits in places of its own");
  std::string packed = bmp(8, std::string("\4\1\0\0\0\1", 6), std::string(16, '\5'));
  packed.replace(30, 4, little(1, 4));
  refused("a.bmp", packed, "is compressed");
  const auto spaced = [](unsigned gamma) {
    std::string text = bmp(24, std::string(12, '\7'));
    text.replace(10, 4, little(14 + 108, 4));
    text.replace(14, 4, little(108, 4));
    return text.insert(54, std::string(16 + 4 + 36, '\0') + little(gamma, 4) + std::string(8, '\0'));
  };
  check_pair(file("a.bmp", spaced(0)), file("b.bmp", spaced(1U << 16U)));

  refused("a.tga", targa(2, 24, 0x40, std::string(12, '\1')), "has interleaved lines");
  refused("a.tga", targa(2, 15, 1, std::string(8, '\1')), "has one bit of alpha");

  // WebP's word for alpha is a hint.
  std::vector<std::uint8_t> rgba(std::size_t{4} * kWidth * kHeight, 128);
  std::string hint = bytes_of(write_webp(folder.path / "a.webp", rgba, 1));
  REQUIRE(hint.substr(12, 4) == "VP8L");
  hint[24] = static_cast<char>(hint[24] & ~0x10);
  const fs::path webp = file("a.webp", hint);
  CHECK(said(webp, webp) == webp.string() + ": has alpha, and its head says that it has none");
  const auto turned = [&](unsigned orientation) {
    const std::string exif = "II" + little(42, 2) + little(8, 4) + little(1, 2) + little(0x112, 2) + little(3, 2) +
                             little(1, 4) + little(orientation, 4) + little(0, 4);
    std::string text = bytes_of(write_webp(folder.path / "b.webp", rgba, 1));
    text.insert(12, "VP8X" + little(10, 4) + little(0x18, 4) + little(kWidth - 1, 3) + little(kHeight - 1, 3));
    text += "EXIF" + little(exif.size(), 4) + exif;
    return text.replace(4, 4, little(text.size() - 8, 4));
  };
  check_pair(file("c.webp", turned(6)), file("d.webp", turned(3)));

  const std::string palette = bytes({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
  const std::string png = png_with_palette(palette, "\x80");
  std::string late = png;
  late.insert(late.size() - 12, png_chunk("eXIf", "II" + little(42, 2) + little(8, 4) + little(0, 2)));
  refused("a.png", late, "has its notes behind the picture (eXIf)");
  std::string profile = png;
  profile.insert(8 + 25, png_chunk("iCCP", std::string("x\0\0abc", 6)));
  const fs::path damaged = file("a.png", profile);
  CHECK(said(damaged, damaged) == damaged.string() + ": has an ICC profile that is damaged");

  refused("a.jpg", "\xFF\xD8\xFF\xE2" + big(10, 2) + std::string("MPF\0abcd", 8), "holds pictures behind the first");
  const std::string siz = big(0, 2) + big(2, 4) + big(2, 4) + big(0, 8) + big(2, 4) + big(2, 4) + big(0, 8);
  refused("a.j2k", "\xFF\x4F\xFF\x51" + big(41, 2) + siz + big(1, 2) + bytes({16, 1, 1}),
          "has values of more than 16 bits");
  const auto radiance = [](const std::string& lines) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n-Y 1 +X 4\n" + std::string(16, '\x80');
  };
  check_pair(file("a.hdr", radiance("")), file("b.hdr", radiance("EXPOSURE=2.0\n")));
}

TEST_CASE("a format of which nobody knows what it loses is refused") {
  const TempFolder folder("lossless-formats");
  const std::vector<std::uint8_t> values(12, 7);
  const auto ico = write_picture(folder.path / "a.ico", OIIO::ImageSpec(2, 2, 3, OIIO::TypeDesc::UINT8), values.data());
  CHECK(said(ico, ico) == ico.string() + ": is of the format ico, which is not read without loss");
  // Its first line comes as zeros, where OpenImageIO has not written the file.
  const auto fits =
      write_picture(folder.path / "a.fits", OIIO::ImageSpec(2, 2, 1, OIIO::TypeDesc::UINT8), values.data());
  CHECK(said(fits, fits) == fits.string() + ": is of the format fits, which is not read without loss");
  const fs::path null = put(folder.path / "a.null", "");
  CHECK(said(null, null) == null.string() + ": is of the format null, which is not read without loss");
}
