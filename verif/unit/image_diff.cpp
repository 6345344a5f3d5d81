// SPDX-License-Identifier: Apache-2.0
// Laws of the picture comparison, and that pictures survive being written and read.
#include <OpenImageIO/imageio.h>
#include <rapidcheck.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>

#include "catch.hpp"
#include "kage/error.hpp"
#include "kage/image.hpp"

namespace fs = std::filesystem;
using kage::diff_files;
using kage::diff_images;
using kage::DiffOptions;
using kage::Image;

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("kage-image-" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

Image random_image(int w, int h, int c) {
  Image image(w, h, c);
  for (auto& v : image.data) v = *rc::gen::element<std::uint8_t>(0, 1, 2, 127, 254, 255);
  return image;
}

fs::path write_float(const fs::path& path, int width, const std::vector<float>& values) {
  const auto output = OIIO::ImageOutput::create("exr");
  output->open(path.string(),
               OIIO::ImageSpec(width, static_cast<int>(values.size()) / width, 1, OIIO::TypeDesc::FLOAT));
  output->write_image(OIIO::TypeDesc::FLOAT, values.data());
  output->close();
  return path;
}

}  // namespace

TEST_CASE("same means equal bits, and nothing else does") {
  CHECK(rc::check([] {
    const Image a = random_image(*rc::gen::inRange(1, 5), *rc::gen::inRange(1, 5), *rc::gen::element(1, 3));
    Image b = a;
    RC_ASSERT(diff_images(a, b).same);
    b.data[*rc::gen::inRange<std::size_t>(0, b.data.size())] ^= 1;
    const auto r = diff_images(a, b);
    RC_ASSERT(!r.same && r.different_pixels == 1 && r.max_lsb == 1 && r.first.has_value());
  }));
}

TEST_CASE("comparison is symmetric") {
  CHECK(rc::check([] {
    const Image a = random_image(4, 3, 3);
    const Image b = random_image(4, 3, 3);
    const DiffOptions o{*rc::gen::inRange<std::uint64_t>(0, 300), {}, {}};
    const auto ab = diff_images(a, b, o);
    const auto ba = diff_images(b, a, o);
    RC_ASSERT(ab.same == ba.same && ab.different_pixels == ba.different_pixels && ab.max_lsb == ba.max_lsb);
    RC_ASSERT(ab.first.has_value() == ba.first.has_value());
    if (ab.first)
      RC_ASSERT(ab.first->x == ba.first->x && ab.first->y == ba.first->y && ab.first->channel == ba.first->channel);
  }));
}

TEST_CASE("a wider tolerance never finds more, and never turns same into different") {
  CHECK(rc::check([] {
    const Image a = random_image(5, 4, 1);
    const Image b = random_image(5, 4, 1);
    const auto lsb = *rc::gen::inRange<std::uint64_t>(0, 256);
    const auto pixels = *rc::gen::inRange<std::uint64_t>(0, 20);
    const auto narrow = diff_images(a, b, {lsb, pixels, {}});
    const auto more_lsb = diff_images(a, b, {lsb + 1, pixels, {}});
    const auto more_pixels = diff_images(a, b, {lsb, pixels + 1, {}});
    RC_ASSERT(more_lsb.different_pixels <= narrow.different_pixels);
    RC_ASSERT(!narrow.same || (more_lsb.same && more_pixels.same));
    RC_ASSERT(diff_images(a, b, {255, {}, {}}).same);
  }));
}

TEST_CASE("the first difference is the first in reading order") {
  Image a(4, 3, 3);
  Image b = a;
  b.data[b.index(2, 1) + 1] = 7;
  b.data[b.index(1, 2)] = 200;
  const auto r = diff_images(a, b);
  REQUIRE(r.first);
  CHECK(r.first->x == 2);
  CHECK(r.first->y == 1);
  CHECK(r.first->channel == 1);
  CHECK(r.different_pixels == 2);
  CHECK(r.max_lsb == 200);
  const auto tolerant = diff_images(a, b, {7, {}, {}});
  REQUIRE(tolerant.first);
  CHECK(tolerant.first->y == 2);
}

TEST_CASE("limits on pixels and on percent both hold when both are given") {
  Image a(10, 10, 1);
  Image b = a;
  for (int i = 0; i < 5; ++i) b.data[static_cast<std::size_t>(i)] = 1;
  CHECK(diff_images(a, b, {0, 5, {}}).same);
  CHECK_FALSE(diff_images(a, b, {0, 4, {}}).same);
  CHECK(diff_images(a, b, {0, {}, 5.0}).same);
  CHECK_FALSE(diff_images(a, b, {0, {}, 4.9}).same);
  CHECK_FALSE(diff_images(a, b, {0, 5, 4.9}).same);
  CHECK_FALSE(diff_images(a, b, {0, 4, 5.0}).same);
}

TEST_CASE("unlike sizes and channels are different, whatever the tolerance") {
  const DiffOptions all{255, 1000000, 100.0};
  CHECK_FALSE(diff_images(Image(2, 3, 1), Image(3, 2, 1), all).same);
  CHECK_FALSE(diff_images(Image(2, 2, 1), Image(2, 2, 3), all).same);
}

TEST_CASE("pictures survive PNG and EXR") {
  const Folder folder;
  for (const int channels : {1, 3}) {
    Image image(16, 16, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<std::uint8_t>(i * 7);
    const fs::path png = folder.path / "a.png";
    save_image(png, image);
    CHECK(kage::load_image(png) == image);
    save_image(folder.path / "a.exr", image);
    image.data[5] ^= 1;
    save_image(folder.path / "b.exr", image);
    CHECK(diff_files(folder.path / "a.exr", folder.path / "a.exr").same);
    CHECK(diff_files(folder.path / "a.exr", folder.path / "b.exr").different_pixels == 1);
    CHECK_FALSE(diff_files(png, folder.path / "a.exr").same);
  }
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator{}) ==
        3);  // no temporary file is left
}

TEST_CASE("floats are told apart by their bits; NaN is never the same, not even as itself") {
  const Folder folder;
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto a = write_float(folder.path / "a.exr", 2, {0.0F, 1.0F, inf, -1.0F});
  const auto b =
      write_float(folder.path / "b.exr", 2,
                  {-0.0F, std::nextafter(1.0F, 2.0F), inf, std::nextafter(std::nextafter(-1.0F, 0.0F), 0.0F)});
  const auto n = write_float(folder.path / "n.exr", 2, {0.0F, 1.0F, inf, nan});
  const auto r = diff_files(a, b);
  CHECK(r.different_pixels == 3);
  CHECK(r.max_lsb == 2);
  CHECK(diff_files(a, b, {1, {}, {}}).different_pixels == 1);
  const auto self = diff_files(n, n, {std::numeric_limits<std::uint64_t>::max(), 100, 100.0});
  CHECK_FALSE(self.same);
  CHECK(self.nan_pixels == 1);
}

TEST_CASE("what is no picture is refused, and names its file") {
  const Folder folder;
  const fs::path text = folder.path / "text.png";
  FILE* f = fopen(text.c_str(), "w");
  fputs("no picture\n", f);
  fclose(f);
  CHECK_THROWS_WITH(kage::load_image(text), Catch::Matchers::ContainsSubstring("text.png"));
  CHECK_THROWS_AS(kage::load_image(folder.path / "missing.png"), kage::Error);
  CHECK_THROWS_AS(kage::load_image(folder.path), kage::Error);
  CHECK_THROWS_AS(kage::save_image(folder.path / "a.tiff", Image(1, 1, 1)), kage::Error);
  CHECK_THROWS_AS(kage::save_image(folder.path / "no/such/folder/a.png", Image(1, 1, 1)), kage::Error);
  CHECK_THROWS_AS(kage::save_image(folder.path / "a.png", Image(0, 1, 1)), kage::Error);
}
