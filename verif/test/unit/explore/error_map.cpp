// SPDX-License-Identifier: Apache-2.0
// Error maps: a map's sums are the figures of a sweep's row, its picture shows each wrong pixel in the colour of what
// is wrong, and people of any colour vision tell the colours apart.
#include "explore/error_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "explore/sweep_accuracy.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::explore;

namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr std::size_t kPixels = std::size_t{64} * 48;

Color pixel(const Image& image, int x, int y) {
  const std::size_t at = image.index(x, y);
  return {image.data[at], image.data[at + 1], image.data[at + 2]};
}

/// How people see a colour [Machado, Oliveira, Fernandes 2009, severity 1]: 0 as most, then without the cones for long,
/// middle and short waves. Linear light.
std::array<double, 3> seen(const Color& color, std::size_t vision) {
  constexpr double kSeen[4][3][3] = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
      {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
      {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
      {{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}};
  std::array<double, 3> linear{};
  std::array<double, 3> out{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double v = color[c] / 255.0;
    linear[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out[r] += kSeen[vision][r][c] * linear[c];
    out[r] = std::clamp(out[r], 0.0, 1.0);
  }
  return out;
}

/// CIELAB of linear sRGB.
std::array<double, 3> lab(const std::array<double, 3>& rgb) {
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = f((0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2]) / 0.9505);
  const double y = f(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
  const double z = f((0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2]) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double apart(const Color& a, const Color& b, std::size_t vision) {
  const auto p = lab(seen(a, vision));
  const auto q = lab(seen(b, vision));
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

}  // namespace

TEST_CASE("people of any colour vision tell apart what a map says") {
  std::vector<std::vector<Color>> kinds{{kFaceColor}, {kGrossColor}, {}, {}, {}};
  for (const int steps : {1, 2, 4, 8, 16, 32, 64, 128}) {
    kinds[2].push_back(shadow_color(steps / 255.0));
    kinds[3].push_back(color_color(steps));
  }
  for (std::uint8_t grey = 0; grey <= 70; grey += 10) kinds[4].push_back({grey, grey, grey});  // the picture beneath
  for (std::size_t vision = 0; vision < 4; ++vision)
    for (std::size_t a = 0; a < kinds.size(); ++a)
      for (std::size_t b = a + 1; b < kinds.size(); ++b)
        for (const Color& p : kinds[a])
          for (const Color& q : kinds[b]) {
            CAPTURE(vision, a, b, int{p[0]}, int{p[1]}, int{p[2]}, int{q[0]}, int{q[1]}, int{q[2]});
            CHECK(apart(p, q, vision) > 15);
          }
  // A greater error is a brighter pixel.
  for (std::size_t vision = 0; vision < 4; ++vision)
    for (std::size_t kind : {2U, 3U})
      for (std::size_t i = 1; i < kinds[kind].size(); ++i)
        CHECK(lab(seen(kinds[kind][i], vision))[0] > lab(seen(kinds[kind][i - 1], vision))[0] + 1);
}

TEST_CASE("a picture of a map has each wrong pixel in its colour, and frames those that lie alone") {
  DrawnFrame under;
  under.width = 64;
  under.height = 48;
  under.color.resize(kPixels, {200, 100, 40});
  ErrorMap map{.width = 64, .height = 48, .pixels = std::vector<PixelError>(kPixels)};
  const auto at = [&](int x, int y) -> PixelError& {
    return map.pixels[std::size_t{64} * static_cast<std::size_t>(y) + static_cast<std::size_t>(x)];
  };
  at(10, 10) = {.face = true, .color = 90, .squares = 8100};
  at(11, 10) = {.shadow = true, .share = 0.5};
  at(40, 10) = {.color = 3, .squares = 9};
  at(40, 30) = {.face = true, .gross = true};
  for (int x = 0; x < 30; ++x) at(x, 40) = {.color = 1, .squares = 1};
  const PictureError sum = sum_of(map);
  CHECK(sum.pixels == kPixels);
  CHECK(sum.visible_wrong == 2);
  CHECK(sum.shadow_wrong == 1);
  CHECK(sum.gross_wrong == 1);
  CHECK(sum.color_wrong == 31);
  CHECK(sum.shadow == 0.5);
  CHECK(sum.squares == 8100 + 9 + 30);
  const Image image = picture_of(map, under);
  REQUIRE(enlargement(64) == 4);
  REQUIRE(image.width == 4 * 64);
  CHECK(pixel(image, 4 * 10, 4 * 10) == kFaceColor);
  CHECK(pixel(image, 4 * 10 + 3, 4 * 10 + 3) == kFaceColor);
  CHECK(pixel(image, 4 * 11, 4 * 10) == shadow_color(0.5));
  CHECK(pixel(image, 4 * 40, 4 * 10) == color_color(3));
  CHECK(pixel(image, 4 * 40, 4 * 30) == kGrossColor);
  CHECK(pixel(image, 4 * 5, 4 * 40) == color_color(1));
  const Color plain = pixel(image, 4 * 60, 4 * 5);
  CHECK((plain[0] == plain[1] && plain[1] == plain[2] && plain[0] < 70 && plain[0] > 20));
  // Frames are three pixels of the picture away; that of a gross error covers others.
  CHECK(pixel(image, 4 * 10 - 3, 4 * 10) == Color{150, 150, 150});
  CHECK(pixel(image, 4 * 12 + 2, 4 * 10) == Color{150, 150, 150});
  CHECK(pixel(image, 4 * 40 - 3, 4 * 10) == Color{150, 150, 150});
  CHECK(pixel(image, 4 * 40 - 3, 4 * 30) == Color{255, 0, 255});
  CHECK(pixel(image, 4 * 40 - 4, 4 * 30) == Color{255, 0, 255});
  CHECK(pixel(image, 4 * 5, 4 * 41 + 2) == plain);  // a line of 30 pixels is seen without a frame
}

TEST_CASE("a map of a point sums up to its row, and a source alone has a map of its own") {
  const auto loaded = std::make_shared<const Scene>(Scene::load("penumbra"));
  const DrawOptions options{.width = 64, .height = 48, .frames = 1, .threads = 1, .name = "penumbra"};
  SweepPoint base;
  base.config = choose_config(*loaded, options).config;
  base.look.fit = true;
  base = with(base, "SIZE", "64x48");
  SweepScene scene(loaded, options, base, [] {});
  const SweepPoint coarse = with(with(base, "SUB_BITS", "4"), "SAMPLES", "3");
  const DrawnFrame drawn = draw(scene.frame(0), coarse.config, scene.draw_options(coarse));
  const ErrorMap map = error_map(scene, 0, coarse, drawn);
  const PointAccuracy row = accuracy_of(scene, 0, coarse, drawn, false);
  const auto count = [&](auto is) {
    return static_cast<std::uint64_t>(std::count_if(map.pixels.begin(), map.pixels.end(), is));
  };
  CHECK(row.by_truth.visible_wrong == count([](const PixelError& e) { return e.face; }));
  CHECK(row.by_truth.visible_wrong > 0);
  CHECK(row.by_truth.shadow_wrong == count([](const PixelError& e) { return e.shadow; }));
  CHECK(row.by_truth.color_wrong > 0);
  CHECK(row.by_truth.gross_wrong == 0);
  for (const ErrorSource source : kErrorSources) {
    CAPTURE(name_of(source));
    const PictureError sum = sum_of(scene.map_of(0, coarse, source));
    const auto kept = scene.error_of(0, coarse, source);
    CHECK(kept->squares == sum.squares);
    CHECK(kept->shadow_wrong == sum.shadow_wrong);
    CHECK(sum.any() == (sum.visible_wrong + sum.shadow_wrong + sum.color_wrong > 0));
  }
  CHECK(scene.error_of(0, coarse, ErrorSource::snapping)->visible_wrong > 0);
  CHECK(scene.error_of(0, coarse, ErrorSource::samples)->shadow_wrong > 0);
  CHECK_FALSE(scene.error_of(0, coarse, ErrorSource::order)->any());
  // A frame that is forgotten is made again, and is the same.
  scene.forget(0);
  CHECK(sum_of(error_map(scene, 0, coarse, drawn)).shadow_wrong == row.by_truth.shadow_wrong);
}
