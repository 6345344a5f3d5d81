// SPDX-License-Identifier: Apache-2.0
// FLIP against what its authors' own evaluator says (flip-evaluator 1.7 of PyPI, evaluate(a, b, "LDR"), pictures as
// below): single precision there, double here, so four digits agree.
#include "image/flip_metric.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "test/support/catch.hpp"

using kage::flip_metric;
using kage::Image;

namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;

enum Kind { kGrey, kCheck, kRamps, kNoise, kGreen, kBlue, kMovedCheck, kRedder };

std::uint8_t value(Kind kind, int x, int y, int c) {
  const auto byte = [](int v) { return static_cast<std::uint8_t>(v); };
  const auto noise = static_cast<std::uint32_t>(x * 73 + y * 151 + c * 37) * 2654435761U;
  const int ramps[] = {4 * x % 256, 5 * y % 256, x * y % 256};
  switch (kind) {
    case kGrey:
      return 128;
    case kCheck:
      return (x / 8 + y / 8) % 2 != 0 ? 255 : 0;
    case kMovedCheck:
      return ((x + 1) / 8 + y / 8) % 2 != 0 ? 255 : 0;
    case kRamps:
      return byte(ramps[c]);
    case kRedder:
      return byte(c == 0 ? std::min(255, ramps[0] + 9) : ramps[c]);
    case kNoise:
      return byte(static_cast<int>(noise >> 24));
    case kGreen:
      return c == 1 ? 255 : 0;
    case kBlue:
      return c == 2 ? 255 : 0;
  }
  return 0;
}

Image picture(Kind kind) {
  Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) image.data[image.index(x, y) + static_cast<std::size_t>(c)] = value(kind, x, y, c);
  return image;
}

}  // namespace

TEST_CASE("FLIP is what the authors' evaluator says") {
  struct Row {
    Kind a;
    Kind b;
    double mean;
    double most;
  };
  constexpr double kHalfDigit = 0.00005;
  for (const Row& row : {Row{kGrey, kGrey, 0, 0},
                         {kGrey, kCheck, 0.845008, 0.983015},
                         {kCheck, kMovedCheck, 0.329846, 0.993284},
                         {kRamps, kRedder, 0.107685, 0.189161},
                         {kRamps, kNoise, 0.788807, 0.983537},
                         {kGreen, kBlue, 1, 1},
                         {kGrey, kNoise, 0.373329, 0.892636}}) {
    CAPTURE(row.a, row.b);
    const kage::FlipNumbers ab = flip_metric(picture(row.a), picture(row.b));
    CHECK(std::abs(ab.mean - row.mean) < kHalfDigit);
    CHECK(std::abs(ab.most - row.most) < kHalfDigit);
    const kage::FlipNumbers ba = flip_metric(picture(row.b), picture(row.a));
    CHECK(ab.mean == ba.mean);
    CHECK(ab.most == ba.most);
  }
}

TEST_CASE("FLIP takes pictures smaller than its filters") {
  for (const int size : {1, 2, 5}) {
    Image black(size, 1, 3);
    Image white(size, 1, 3);
    std::fill(white.data.begin(), white.data.end(), std::uint8_t{255});
    CHECK(flip_metric(black, black).most == 0);
    CHECK(flip_metric(black, white).mean > 0.9);
  }
}
