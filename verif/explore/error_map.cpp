// SPDX-License-Identifier: Apache-2.0
#include "explore/error_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "image/regions.hpp"
#include "image/views.hpp"

namespace kage::explore {
namespace {

using Color = std::array<std::uint8_t, 3>;

// Colours of frames round pixels; no pixel has them.
constexpr Color kFrame{150, 150, 150};
constexpr Color kGrossFrame{255, 0, 255};

// A region whose box is larger is seen without a frame.
constexpr int kAlone = 16;

// Pictures are enlarged towards this width, so that a pixel is seen, but no more than so many times.
constexpr int kWide = 1280;
constexpr int kMostEnlarged = 4;

// How bright the picture under the map is at most.
constexpr double kDimmed = 70;

Color between(const Color& from, const Color& to, double at) {
  Color out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround(from[c] + at * (double{static_cast<double>(to[c])} - from[c])));
  return out;
}

void add_color(PixelError& e, const Color& expected, const Color& drawn) {
  for (std::size_t c = 0; c < 3; ++c) {
    const int off = std::abs(int{expected[c]} - int{drawn[c]});
    e.color = std::max(e.color, static_cast<std::uint8_t>(off));
    e.squares += static_cast<std::uint32_t>(off * off);
  }
}

/// How far the shares of the first lights in shadow are apart at most; 0 only if all are equal.
double share_off(const std::array<std::uint8_t, 8>& a, const std::vector<int>& of_a,
                 const std::array<std::uint8_t, 8>& b, const std::vector<int>& of_b) {
  double most = 0;
  for (std::size_t l = 0; l < std::min(of_a.size(), a.size()); ++l)
    most = std::max(most, std::abs(a[l] * of_b[l] - b[l] * of_a[l]) / (double{static_cast<double>(of_a[l])} * of_b[l]));
  return most;
}

Color color_of(const PixelError& e) {
  if (e.gross) return kGrossColor;
  if (e.face) return kFaceColor;
  return e.shadow ? shadow_color(e.share) : color_color(e.color);
}

/// How bright a difference is painted, 0 .. 1: a step for each doubling.
double level(int steps) { return (std::bit_width(static_cast<unsigned>(std::clamp(steps, 1, 255))) - 1) / 7.0; }

/// Frames what of the map is `framed`, and lies alone.
template <class Framed>
void frame_alone(Image& image, const ErrorMap& map, const Color& color, int thick, Framed framed) {
  RegionFinder finder(map.width);
  std::size_t i = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      if (framed(map.pixels[i++])) finder.add(x, y);
  auto regions = finder.regions();
  std::erase_if(regions, [](const auto& r) { return std::max(r.box.width, r.box.height) > kAlone; });
  const int side = enlargement(map.width);
  for (auto& r : regions) r.box = {side * r.box.x, side * r.box.y, side * r.box.width, side * r.box.height};
  for (int t = 0; t < thick; ++t) {
    frame_regions(image, regions, color);
    for (auto& r : regions) r.box = {r.box.x - 1, r.box.y - 1, r.box.width + 2, r.box.height + 2};
  }
}

/// Paints a pixel of the map.
void paint_square(Image& image, int side, int x, int y, const Color& color) {
  for (int row = side * y; row < side * (y + 1); ++row)
    for (int column = side * x; column < side * (x + 1); ++column)
      std::copy(color.begin(), color.end(), &image.data[image.index(column, row)]);
}

}  // namespace

PictureError& PictureError::operator+=(const PictureError& o) {
  pixels += o.pixels;
  visible_wrong += o.visible_wrong;
  shadow_wrong += o.shadow_wrong;
  gross_wrong += o.gross_wrong;
  color_wrong += o.color_wrong;
  shadow += o.shadow;
  squares += o.squares;
  return *this;
}

bool PictureError::any() const { return visible_wrong + shadow_wrong + gross_wrong + color_wrong > 0; }

PictureError sum_of(const ErrorMap& map) {
  PictureError out;
  for (const PixelError& e : map.pixels) {
    ++out.pixels;
    if (e.face) ++out.visible_wrong;
    if (e.shadow) ++out.shadow_wrong;
    if (e.gross) ++out.gross_wrong;
    if (e.color_alone()) ++out.color_wrong;
    out.shadow += e.share;
    out.squares += e.squares;
  }
  return out;
}

ErrorMap against_truth(const ScreenTruth& truth, const DrawnFrame& finest, const DrawnFrame& drawn,
                       const std::vector<int>& samples) {
  ErrorMap out{.width = truth.width, .height = truth.height, .pixels = std::vector<PixelError>(truth.pixels.size())};
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    PixelError& e = out.pixels[i];
    const PixelFault fault = fault_of(truth.pixels[i], drawn, i);
    e.face = fault == PixelFault::face;
    e.shadow = fault == PixelFault::shadow;
    if (e.shadow) e.share = share_off(truth.pixels[i].counts, samples, drawn.counts[i], samples);
    add_color(e, finest.color[i], drawn.color[i]);
  }
  return out;
}

ErrorMap against_picture(const DrawnFrame& expected, const std::vector<int>& expected_samples, const DrawnFrame& drawn,
                         const std::vector<int>& samples) {
  ErrorMap out{
      .width = expected.width, .height = expected.height, .pixels = std::vector<PixelError>(expected.face.size())};
  for (std::size_t i = 0; i < out.pixels.size(); ++i) {
    PixelError& e = out.pixels[i];
    e.face = expected.face[i] != drawn.face[i];
    if (!e.face) e.share = share_off(expected.counts[i], expected_samples, drawn.counts[i], samples);
    e.shadow = e.share > 0;
    add_color(e, expected.color[i], drawn.color[i]);
  }
  return out;
}

std::array<std::uint8_t, 3> shadow_color(double share) {
  return between({0, 90, 165}, {95, 190, 255}, level(static_cast<int>(std::lround(share * 255))));
}

std::array<std::uint8_t, 3> color_color(int steps) { return between({105, 40, 20}, {225, 85, 0}, level(steps)); }

int enlargement(int width) { return std::clamp(kWide / width, 1, kMostEnlarged); }

Image picture_of(const ErrorMap& map, const DrawnFrame& under) {
  const int side = enlargement(map.width);
  Image image(side * map.width, side * map.height, 3);
  const auto each = [&map](auto paint) {
    std::size_t i = 0;
    for (int y = 0; y < map.height; ++y)
      for (int x = 0; x < map.width; ++x) paint(x, y, i++);
  };
  each([&](int x, int y, std::size_t i) {
    const Color& c = under.color[i];
    const double grey = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    const auto dim = static_cast<std::uint8_t>(std::lround(grey * kDimmed / 255));
    paint_square(image, side, x, y, {dim, dim, dim});
  });
  frame_alone(image, map, kFrame, 1, [](const PixelError& e) { return e.face || e.shadow; });
  frame_alone(image, map, kFrame, 1, [](const PixelError& e) { return e.color_alone(); });
  frame_alone(image, map, kGrossFrame, 2, [](const PixelError& e) { return e.gross; });
  each([&](int x, int y, std::size_t i) {
    if (map.pixels[i].any()) paint_square(image, side, x, y, color_of(map.pixels[i]));
  });
  return image;
}

}  // namespace kage::explore
