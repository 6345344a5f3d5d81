// SPDX-License-Identifier: Apache-2.0
// Picture files: that they survive being written and read, and what of a file makes it different from another.
#include <cmath>

#include "kage/diff.hpp"
#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/pictures.hpp"

namespace kage::verif {
namespace {

namespace fs = std::filesystem;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// As tolerant as can be, for floats.
DiffOptions everything() {
  DiffOptions o;
  o.ulp = std::numeric_limits<std::uint64_t>::max();
  o.max_pixels = 100;
  o.max_percent = 100;
  return o;
}

}  // namespace

TEST_CASE("pictures survive PNG and EXR") {
  const TempFolder folder("image-files");
  for (const int channels : {1, 3}) {
    Image image(16, 16, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<std::uint8_t>(i * 7);
    const fs::path png = folder.path / "a.png";
    save_image(png, image);
    CHECK(load_image(png) == image);
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

TEST_CASE("floats are told apart by their bits") {
  const TempFolder folder("image-files");
  const float inf = std::numeric_limits<float>::infinity();
  const auto a = write_floats(folder.path / "a.exr", 2, 1, {0.0F, 1.0F, inf, -1.0F});
  const auto b =
      write_floats(folder.path / "b.exr", 2, 1,
                   {-0.0F, std::nextafter(1.0F, 2.0F), inf, std::nextafter(std::nextafter(-1.0F, 0.0F), 0.0F)});
  const auto r = diff_files(a, b);
  CHECK(r.different_pixels == 3);
  CHECK(r.max_ulp == 2U);
  DiffOptions o;
  o.ulp = 1;
  CHECK(diff_files(a, b, o).different_pixels == 1);
  o = {};
  o.abs = 0;
  CHECK(diff_files(a, b, o).different_pixels == 3);  // none is the same as a threshold of 0
  o.abs = 1e-30;
  CHECK(diff_files(a, b, o).different_pixels == 2);
  const auto far = write_floats(folder.path / "far.exr", 2, 1, {0.0F, 1.0F, -inf, -1.0F});
  o.abs = std::numeric_limits<double>::max();
  CHECK(diff_files(a, far, o).different_pixels == 1);
  o = {};
  o.lsb = 100;
  CHECK_THROWS_WITH(diff_files(a, b, o), Catch::Matchers::ContainsSubstring("a.exr") &&
                                             Catch::Matchers::ContainsSubstring("threshold lsb is for integers"));
  o = {};
  o.abs = inf;
  CHECK_THROWS_AS(diff_files(a, b, o), Error);
}

TEST_CASE("a NaN is never the same: not as itself, not in alpha, not outside region and mask") {
  const TempFolder folder("image-files");
  const auto check = [&](const std::vector<float>& values, const DiffOptions& o) {
    const auto n = write_floats(folder.path / "n.exr", 2, 4, values);
    const auto good = write_floats(folder.path / "g.exr", 2, 4, std::vector<float>(8, 0.5F));
    for (const auto& [x, y] : {std::pair{n, n}, {n, good}, {good, n}}) {
      DiffViews views;
      const auto r = diff_files(x, y, o, &views);
      CHECK_FALSE(r.same);
      CHECK(r.nan_pixels == 1);
      CHECK_THAT(r.reason, Catch::Matchers::ContainsSubstring("NaN"));
      CHECK_FALSE(r.psnr);
    }
  };
  const std::vector<float> first{kNan, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F};
  const std::vector<float> alpha{0.5F, 0.5F, 0.5F, -kNan, 0.5F, 0.5F, 0.5F, 0.5F};
  check(first, {});
  check(first, everything());
  check(alpha, everything());
  DiffOptions o = everything();
  o.ignore_alpha = true;
  check(alpha, o);
  o.region = Box{1, 0, 1, 1};
  check(first, o);
  o = everything();
  o.mask = Image(2, 1, 1);
  o.mask.data = {0, 1};
  check(first, o);
}

TEST_CASE("half and double have their own distances and NaN") {
  const TempFolder folder("image-files");
  const std::vector<std::uint16_t> half_a{0x3C00, 0x0000, 0xFC00, 0x7BFF};
  const std::vector<std::uint16_t> half_b{0x3C01, 0x8000, 0xFC00, 0x7BFE};
  const ImageSpec half(4, 1, 1, TypeDesc::HALF);
  const auto a = write_picture(folder.path / "a.exr", half, half_a.data());
  const auto b = write_picture(folder.path / "b.exr", half, half_b.data());
  const auto r = diff_files(a, b);
  CHECK(r.different_pixels == 3);
  CHECK(r.max_ulp == 1U);
  CHECK(r.max_abs == 32.0);  // of the two largest halves
  DiffOptions o;
  o.ulp = 1;
  CHECK(diff_files(a, b, o).same);
  const std::vector<std::uint16_t> nan(4, 0xFE00);
  CHECK(diff_files(a, write_picture(folder.path / "n.exr", half, nan.data()), everything()).nan_pixels == 4);

  const ImageSpec wide(2, 2, 1, TypeDesc::DOUBLE);
  const std::vector<double> double_a{1.0, 0.1, 0, 7};
  const std::vector<double> double_b{std::nextafter(1.0, 2.0), 0.1, 0, 7};
  CHECK(diff_files(write_picture(folder.path / "a.tif", wide, double_a.data()),
                   write_picture(folder.path / "b.tif", wide, double_b.data()))
            .max_ulp == 1U);
}

TEST_CASE("channels of several types keep their own: no integer is rounded by way of float") {
  const TempFolder folder("image-files");
  ImageSpec spec(1, 1, 2, TypeDesc::FLOAT);
  spec.channelnames = {"Z", "id"};
  spec.channelformats = {TypeDesc::HALF, TypeDesc::UINT32};
  const std::vector<unsigned char> x{0x00, 0x3C, 0x00, 0x00, 0x00, 0xFF};
  const std::vector<unsigned char> y{0x00, 0x3C, 0x01, 0x00, 0x00, 0xFF};  // as float it would be the same
  const auto a = write_picture(folder.path / "a.exr", spec, x.data());
  const auto b = write_picture(folder.path / "b.exr", spec, y.data());
  CHECK(diff_files(a, a).same);
  const auto r = diff_files(a, b);
  CHECK(r.different_pixels == 1);
  CHECK(r.max_lsb == 1U);
  CHECK(r.max_ulp == 0U);
  REQUIRE(r.first);
  CHECK(r.first->channel == 1);
  DiffOptions o;
  o.lsb = 1;
  CHECK_THROWS_AS(diff_files(a, b, o), Error);
  o = {};
  o.abs = 1;
  CHECK_THROWS_AS(diff_files(a, b, o), Error);
}

TEST_CASE("what a file says of its numbers is compared: types, channels, colour space, place") {
  const TempFolder folder("image-files");
  const std::vector<unsigned char> zeros(128);
  int number = 0;
  const auto file = [&](const char* extension, const ImageSpec& spec) {
    return write_picture(folder.path / (std::to_string(number++) + extension), spec, zeros.data());
  };
  const auto unlike = [&](const fs::path& a, const fs::path& b, const std::string& what) {
    for (const auto& [x, y] : {std::pair{a, b}, {b, a}}) {
      DiffOptions o;
      o.max_percent = 100;
      o.ignore_alpha = true;
      DiffViews views;
      const auto r = diff_files(x, y, o, &views);
      CHECK_FALSE(r.same);
      CHECK(r.width == 0);
      CHECK(views.heat.data.empty());
      CHECK_THAT(r.reason, Catch::Matchers::ContainsSubstring(what));
    }
  };
  const ImageSpec plain(4, 2, 3, TypeDesc::UINT8);
  const auto png = file(".png", plain);
  CHECK(diff_files(png, file(".png", plain)).same);
  unlike(png, file(".png", ImageSpec(2, 4, 3, TypeDesc::UINT8)), "sizes");
  unlike(png, file(".png", ImageSpec(4, 2, 4, TypeDesc::UINT8)), "channels");
  unlike(png, file(".png", ImageSpec(4, 2, 3, TypeDesc::UINT16)), "pixel types");
  ImageSpec linear = plain;
  linear.attribute("oiio:ColorSpace", "Gamma1.8");
  linear.attribute("oiio:Gamma", 1.8F);
  unlike(png, file(".png", linear), "colour space");
  ImageSpec profile = plain;
  const std::vector<unsigned char> icc(300, 7);
  profile.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, 300), icc.data());
  unlike(file(".tif", plain), file(".tif", profile), "ICC profile");
  ImageSpec ten(4, 2, 1, TypeDesc::UINT16);
  ten.attribute("oiio:BitsPerSample", 10);
  ImageSpec twelve = ten;
  twelve.attribute("oiio:BitsPerSample", 12);
  unlike(file(".dpx", ten), file(".dpx", twelve), "number of bits");

  const ImageSpec exr(4, 2, 3, TypeDesc::FLOAT);
  const auto at_zero = file(".exr", exr);
  ImageSpec moved = exr;
  moved.x = 1;
  unlike(at_zero, file(".exr", moved), "origins");
  ImageSpec window = exr;
  window.full_width = 8;
  unlike(at_zero, file(".exr", window), "display window");
  ImageSpec named = exr;
  named.channelnames = {"R", "G", "Z"};
  unlike(at_zero, file(".exr", named), "channels");
  // One name that reads like several.
  ImageSpec one(4, 2, 1, TypeDesc::FLOAT);
  one.channelnames = {"R,G"};
  ImageSpec two(4, 2, 2, TypeDesc::FLOAT);
  two.channelnames = {"R", "G"};
  unlike(file(".exr", one), file(".exr", two), "\"R,G\"");
  const std::vector<float> primaries{0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.3290F};
  ImageSpec coloured = exr;
  coloured.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), primaries.data());
  unlike(at_zero, file(".exr", coloured), "chromaticity");
  ImageSpec bright = exr;
  bright.attribute("whiteLuminance", 100.0F);
  unlike(at_zero, file(".exr", bright), "white luminance");
  ImageSpec turned = plain;
  turned.attribute("Orientation", 6);
  unlike(file(".tif", plain), file(".tif", turned), "orientation");
}

TEST_CASE("alpha is compared unless it is to be ignored; masks go by what is not alpha") {
  const TempFolder folder("image-files");
  const ImageSpec rgba(2, 1, 4, TypeDesc::UINT8);
  std::vector<unsigned char> values{1, 2, 3, 255, 4, 5, 6, 255};
  const auto a = write_picture(folder.path / "a.png", rgba, values.data());
  values[7] = 254;
  const auto b = write_picture(folder.path / "b.png", rgba, values.data());
  CHECK_FALSE(diff_files(a, b).same);
  DiffOptions o;
  o.ignore_alpha = true;
  CHECK(diff_files(a, b, o).same);
  CHECK(diff_files(a, b, o).max_lsb == 0U);
  values[6] = 7;
  CHECK_FALSE(diff_files(a, write_picture(folder.path / "c.png", rgba, values.data()), o).same);

  std::vector<unsigned char> mask{0, 0, 0, 255, 0, 1, 0, 0};
  const Image read = load_mask(write_picture(folder.path / "m.png", rgba, mask.data()));
  CHECK(read.data == std::vector<std::uint8_t>{0, 255});
  mask[5] = 0;
  CHECK_THROWS_WITH(load_mask(write_picture(folder.path / "m.png", rgba, mask.data())),
                    Catch::Matchers::ContainsSubstring("m.png"));
  CHECK_THROWS_AS(load_mask(write_floats(folder.path / "m.exr", 2, 1, {1.0F, kNan})), Error);
}

TEST_CASE("the heat map shows each pixel's verdict, the flip picture both pictures") {
  const TempFolder folder("image-files");
  Image a(40, 1, 3);
  Image b = a;
  b.data[b.index(1, 0)] = 1;
  b.data[b.index(30, 0)] = 200;
  b.data[b.index(39, 0)] = 200;
  save_image(folder.path / "a.png", a);
  save_image(folder.path / "b.png", b);
  DiffOptions o;
  o.lsb = 1;
  o.region = Box{0, 0, 39, 1};
  DiffViews views;
  CHECK(diff_files(folder.path / "a.png", folder.path / "b.png", o, &views).different_pixels == 1);
  const auto at = [&](int x) {
    const std::uint8_t* const p = &views.heat.data[views.heat.index(x, 0)];
    return std::vector<int>{p[0], p[1], p[2]};
  };
  CHECK(at(0) == std::vector<int>{0, 0, 0});
  CHECK(at(1) == std::vector<int>{112, 84, 0});
  CHECK(at(30) == std::vector<int>{255, 0, 0});
  CHECK(at(39) == std::vector<int>{0, 0, 64});
  CHECK(at(27) == std::vector<int>{0, 160, 160});  // the frame round the region
  CHECK(views.a == a);
  CHECK(views.b == b);

  const fs::path flip = folder.path / "flip.png";
  save_blink(flip, views.a, Image(50, 2, 3));
  CHECK_THROWS_WITH(load_image(flip), Catch::Matchers::ContainsSubstring("animated"));
  CHECK_THROWS_WITH(diff_files(flip, flip), Catch::Matchers::ContainsSubstring("flip.png"));
  const auto input = OIIO::ImageInput::open(flip.string());  // which shows the first picture
  REQUIRE(input);
  CHECK(input->spec().width == 50);
  CHECK(input->spec().height == 2);
  std::vector<std::uint8_t> pixels(300);
  REQUIRE(input->read_image(0, 0, 0, 3, TypeDesc::UINT8, pixels.data()));
  CHECK(std::equal(a.data.begin(), a.data.end(), pixels.begin()));
  CHECK_THROWS_AS(save_blink(folder.path / "no/flip.png", a, b), Error);
  CHECK_THROWS_AS(save_blink(folder.path / "flip.gif", a, b), Error);
  CHECK_THROWS_AS(save_blink(flip, Image(), b), Error);
}

TEST_CASE("the perceptual measure tells what is seen from what is not, and decides nothing") {
  const TempFolder folder("image-files");
  Image a(64, 64, 3);
  for (std::uint8_t& v : a.data) v = 128;
  Image faint = a;
  Image plain = a;
  for (int y = 20; y < 40; ++y)
    for (int x = 20; x < 40; ++x) {
      faint.data[faint.index(x, y)] += 1;
      plain.data[plain.index(x, y)] = 255;
    }
  save_image(folder.path / "a.png", a);
  save_image(folder.path / "faint.png", faint);
  save_image(folder.path / "plain.png", plain);
  DiffOptions o;
  CHECK_FALSE(diff_files(folder.path / "a.png", folder.path / "plain.png", o).perceptual_pixels);
  o.perceptual = true;
  const auto unseen = diff_files(folder.path / "a.png", folder.path / "faint.png", o);
  CHECK(unseen.perceptual_pixels == 0U);
  CHECK_FALSE(unseen.same);
  CHECK(diff_files(folder.path / "a.png", folder.path / "plain.png", o).perceptual_pixels.value_or(0) > 100);
  const auto n = write_floats(folder.path / "n.exr", 8, 3, std::vector<float>(192, kNan));
  CHECK_FALSE(diff_files(n, n, o).perceptual_pixels);
}

TEST_CASE("what is no picture is refused, and names its file") {
  const TempFolder folder("image-files");
  const fs::path text = folder.path / "text.png";
  std::ofstream(text) << "no picture\n";
  CHECK_THROWS_WITH(load_image(text), Catch::Matchers::ContainsSubstring("text.png"));
  CHECK_THROWS_AS(load_image(folder.path / "missing.png"), Error);
  CHECK_THROWS_AS(load_image(folder.path), Error);
  CHECK_THROWS_AS(save_image(folder.path / "a.tiff", Image(1, 1, 1)), Error);
  CHECK_THROWS_AS(save_image(folder.path / "no/such/folder/a.png", Image(1, 1, 1)), Error);
  CHECK_THROWS_AS(save_image(folder.path / "a.png", Image(0, 1, 1)), Error);
}

}  // namespace kage::verif
