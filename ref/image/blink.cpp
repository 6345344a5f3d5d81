// SPDX-License-Identifier: Apache-2.0
//
// Animated PNG, written here because OpenImageIO writes none. OpenImageIO's other animated format, GIF, has only 256
// colours, and would show differences that are none. An animated PNG is a PNG with three more kinds of chunks, so
// programs that do not know them show the first picture:
//   acTL  how many pictures there are
//   fcTL  how long one is shown
//   fdAT  the data of all but the first
#include "image/blink.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <new>
#include <vector>

#include "file/extension.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

using Bytes = std::vector<unsigned char>;

void put(Bytes& out, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) out.push_back(static_cast<unsigned char>(value >> shift));
}

/// A chunk: length, name, content, checksum of the last two.
void chunk(OutputFile& out, const char* name, const Bytes& content) {
  Bytes head;
  put(head, static_cast<std::uint32_t>(content.size()));
  head.insert(head.end(), name, name + 4);
  uLong crc = crc32_z(0, head.data() + 4, 4);
  if (!content.empty()) crc = crc32_z(crc, content.data(), content.size());
  Bytes tail;
  put(tail, static_cast<std::uint32_t>(crc));
  for (const Bytes* part : {static_cast<const Bytes*>(&head), &content, static_cast<const Bytes*>(&tail)})
    out.write(reinterpret_cast<const char*>(part->data()), static_cast<std::streamsize>(part->size()));
}

/// The lines of `image` as PNG compresses them, black to the right and below up to width x height. Each line begins
/// with the number of its filter, 1, which makes bytes differences to the pixel on the left.
Bytes compressed(const Image& image, int width, int height, const std::string& name) {
  const std::size_t line = static_cast<std::size_t>(width) * 3 + 1;
  Bytes raw(line * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    unsigned char* const out = raw.data() + static_cast<std::size_t>(y) * line;
    out[0] = 1;
    if (y < image.height)
      std::copy_n(&image.data[image.index(0, y)], static_cast<std::size_t>(image.width) * 3, out + 1);
    for (std::size_t i = line - 1; i > 3; --i) out[i] = static_cast<unsigned char>(out[i] - out[i - 3]);
  }
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  Bytes data(size);
  if (compress2(data.data(), &size, raw.data(), static_cast<uLong>(raw.size()), 6) != Z_OK) throw std::bad_alloc();
  data.resize(size);
  if (size > 0x7FFF0000U) throw Error(fmt::format("{}: cannot be written: the pictures are too large", name));
  return data;
}

/// Picture number `sequence` of the animation: its size, and half a second.
Bytes frame_control(std::uint32_t sequence, int width, int height) {
  Bytes content;
  put(content, sequence);
  put(content, static_cast<std::uint32_t>(width));
  put(content, static_cast<std::uint32_t>(height));
  put(content, 0);  // at 0, 0
  put(content, 0);
  const std::array<unsigned char, 6> rest{0, 1, 0, 2, 0, 0};  // 1/2 second; nothing is cleared after it or blended
  content.insert(content.end(), rest.begin(), rest.end());
  return content;
}

}  // namespace

void save_blink(TempFiles& files, const std::filesystem::path& path, const Image& a, const Image& b) {
  const std::string name = path.string();
  if (a.channels != 3 || b.channels != 3 || a.data.empty() || b.data.empty())
    throw Error(fmt::format("{}: cannot be written: a blink picture is of two pictures of three channels", name));
  if (const std::string extension = lower_extension(path); extension != ".png" && extension != ".apng")
    throw Error(fmt::format("{}: cannot be written: a blink picture is a .png or .apng", name));
  const int width = std::max(a.width, b.width);
  const int height = std::max(a.height, b.height);

  OutputFile out(files, path);
  out.write("\x89PNG\r\n\x1a\n", 8);
  Bytes header;
  put(header, static_cast<std::uint32_t>(width));
  put(header, static_cast<std::uint32_t>(height));
  const std::array<unsigned char, 5> rgb{8, 2, 0, 0, 0};  // 8 bits, red green blue, not interlaced
  header.insert(header.end(), rgb.begin(), rgb.end());
  chunk(out, "IHDR", header);
  Bytes animation;
  put(animation, 2);  // pictures
  put(animation, 0);  // for ever
  chunk(out, "acTL", animation);
  chunk(out, "fcTL", frame_control(0, width, height));
  chunk(out, "IDAT", compressed(a, width, height, name));
  chunk(out, "fcTL", frame_control(1, width, height));
  Bytes second;
  put(second, 2);  // chunks of the animation are numbered
  const Bytes data = compressed(b, width, height, name);
  second.insert(second.end(), data.begin(), data.end());
  chunk(out, "fdAT", second);
  chunk(out, "IEND", {});
  out.close();
}

void save_blink(const std::filesystem::path& path, const Image& a, const Image& b) {
  TempFiles file;
  save_blink(file, path, a, b);
  file.commit();
}

}  // namespace kage
