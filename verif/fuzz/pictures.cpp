// SPDX-License-Identifier: Apache-2.0
// Pictures: the heads of all files, which kage itself looks at, and PNG and WebP as a whole. The rest is
// OpenImageIO's.
#include <optional>

#include "file/read_file.hpp"
#include "fuzz/target.hpp"
#include "image/picture.hpp"
#include "image/plugin/lossless.hpp"
#include "image/plugin/webp.hpp"
#include "image/png_chunks.hpp"
#include "image/png_reader.hpp"
#include "kage/error.hpp"
#include "kage/image.hpp"
#include "stimulus/png_chunk.hpp"

namespace kage::fuzz {
namespace {

void run_head(Bytes bytes) {
  for (const char* name : {"p.tga", "p.any"}) {
    const auto path = file_of(name, bytes);
    (void)read_png_chunks(path);
    try {
      picture_plugin::refuse_lossy_file(path);
    } catch (const Error&) {  // the next name may be taken
    }
  }
}

std::vector<std::string> head_seeds() {
  const auto text = [](std::initializer_list<int> list) {
    std::string all;
    for (const int b : list) all += static_cast<char>(b);
    return all;
  };
  return {text({'G', 'I', 'F', '8', '9', 'a',  1, 0, 1, 0, 0x80, 0, 0, 1, 2, 3, 4, 5,    6, 0x21, 0xF9, 4,
                0,   0,   0,   0,   0,   0x2C, 0, 0, 0, 0, 1,    0, 1, 0, 0, 2, 2, 0x4C, 1, 0,    0x3B}),
          "DDS " + std::string(76, '\4') + "DXT1" + std::string(40, '\0'),
          text({'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 64, 1, 3, 0, 3, 0, 0, 0, 26, 0, 0, 0, 0, 0, 0, 0, 1, 1, 2, 2, 3, 3}),
          text({0, 1, 1, 0, 0, 1, 0, 32, 0, 0, 0, 0, 1, 0, 1, 0, 8, 0x28, 1, 2, 3, 4, 0})};
}

/// By kage's own reader; nothing where it refuses the file.
std::optional<Picture> own_png(const std::filesystem::path& path) {
  try {
    const auto reader = open_png(path, -1, std::uint64_t{1} << 24);
    if (reader->line_bytes() * static_cast<std::uint64_t>(reader->head().height) > std::uint64_t{1} << 20) return {};
    return whole_picture(*reader);
  } catch (const Error&) {
    return {};
  }
}

void run_png(Bytes bytes) {
  const auto path = file_of("p.png", bytes);
  const std::optional<Picture> own = own_png(path);
  const auto reader = open_picture(path);
  if (reader->line_bytes() * static_cast<std::uint64_t>(reader->head().height) > std::uint64_t{1} << 20) return;
  const Picture picture = whole_picture(*reader);
  require(unlike(picture, picture).empty(), "a picture is like itself");
  if (own && is_png(path)) require(own->data == picture.data, "both readers of PNG read the same");
}

std::vector<std::string> png_seeds() {
  const auto path = file_of("seed.png", {});
  std::vector<std::string> seeds;
  for (const int channels : {1, 3}) {
    save_image(path, Image(4, 3, channels));
    seeds.push_back(read_file(path));
  }
  constexpr std::size_t kHead = 33;  // the signature, and IHDR
  using namespace std::string_literals;
  seeds.push_back(seeds[0]);
  seeds.back().insert(kHead, verif::png_chunk("eXIf", "MM\0*\0\0\0\b\0\1\1\22\0\3\0\0\0\1\0\6\0\0\0\0\0\0"s) +
                                 verif::png_chunk("gAMA", "\0\0\261\217"s));
  return seeds;
}

void run_webp(Bytes bytes) {
  const picture_plugin::WebpHead head = picture_plugin::webp_head("p.webp", bytes);
  const std::uint64_t size =
      std::uint64_t{4} * static_cast<std::uint64_t>(head.width) * static_cast<std::uint64_t>(head.height);
  if (size > std::uint64_t{1} << 20) return;
  std::vector<std::byte> pixels(size);
  picture_plugin::webp_pixels("p.webp", bytes, head, pixels);
}

/// One pixel of red, without loss, under alpha 0.
std::vector<std::string> webp_seeds() {
  return {std::string("RIFF\x1a\0\0\0WEBPVP8L\x0d\0\0\0\x2f\0\0\0\x10\x07\x10\xfd\x8f\x02\x06\x22\xa2\xff\x01\0", 34)};
}

}  // namespace

std::span<const Target> picture_targets() {
  static const Target kTargets[] = {{"picture", "the heads of pictures", run_head, head_seeds},
                                    {"png", "PNG", run_png, png_seeds},
                                    {"webp", "WebP", run_webp, webp_seeds}};
  return kTargets;
}

}  // namespace kage::fuzz
