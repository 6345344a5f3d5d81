// SPDX-License-Identifier: Apache-2.0
// Families 15 - 19: depth and colour along spans.
#include <algorithm>
#include <cmath>

#include "frontend/span_setup.hpp"
#include "opinion/judge.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "extremes/screen.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 40;

std::uint32_t pixel(const std::vector<std::uint32_t>& p, int x, int y) {
  return p[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
}

}  // namespace

TEST_CASE("family 15: the error after k pixels is at most (k + 1) 2^-(f+1), and no accumulator wraps") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 20000; ++round) {
    const int z_bits = random.in(4, 28);
    const int frac = random.in(0, 16);
    const int bits = z_bits + frac + 2;
    const SpanSetup setup(frac, bits);
    const int count = random.in(1, 2000);
    const int x = random.in(0, 30000);
    // From one end of depth to the other along the span, in either direction.
    const double top = std::ldexp(1.0, z_bits) - 2;
    const double from = random.chance(0.3) ? 1 : random.real(1, top);
    const double to = random.chance(0.3) ? top : random.real(1, top);
    ScreenPlane p;
    p.x0 = x - random.in(-1000, 1000);
    p.y0 = 0;
    p.a = static_cast<std::int64_t>((to - from) / std::max(count - 1, 1) * (1 << kPlaneFrac));
    p.c = static_cast<std::int64_t>(from * (1 << kPlaneFrac)) - p.a * (x - p.x0);
    const SpanSetup::Ramp r = setup.at(p, x, 0, count);
    CAPTURE(round, z_bits, frac, count);
    const Int128 limit = static_cast<Int128>(1) << (bits - 1);
    const std::int64_t half = frac > 0 ? std::int64_t{1} << (frac - 1) : 0;
    for (const int k : {0, 1, count / 2, count - 1}) {
      if (k >= count) continue;
      const Int128 acc = static_cast<Int128>(r.start) + static_cast<Int128>(r.step) * k;
      REQUIRE(acc >= -limit);
      REQUIRE(acc < limit);
      // All in 2^-24 LSB.
      const Int128 error = ((acc - half) << (kPlaneFrac - frac)) - value_at(p, x + k, 0);
      const Int128 bound = static_cast<Int128>(k + 1) << (kPlaneFrac - frac - 1);
      REQUIRE(error <= bound);
      REQUIRE(-error <= bound);
    }
  }
}

TEST_CASE("family 15: a plane past either end is clamped, not wrapped") {
  // Depth 1 is nearest: what is nearer still stays in front, what is further than the end stays behind.
  for (const double slope : {-1e6, -1e5, 1e5, 1e6}) {
    FrameBuilder b(kWidth, kHeight);
    b.add(rectangle(0, 0, kWidth, kHeight), plane(8e6), {1, 1, 1});
    b.add(rectangle(0, 0, kWidth, kHeight), plane(8e6, slope, 0, kWidth / 2, 0), {2, 2, 2});
    const auto p = draw(b.frame(), Config{});
    for (int x = 0; x < kWidth; ++x) {
      const int along = x - kWidth / 2;
      CHECK(pixel(p, x, 5) == (along * slope < 0 ? 0x020202U : 0x010101U));
    }
  }
}

TEST_CASE("family 16: depth that is whole at every pixel is stored as it is") {
  // A surface one LSB behind is hidden, one at the same depth is hidden, one LSB in front is seen, at every pixel.
  for (const int slope : {0, 1, -1, 1000, -1000, 65536})
    for (const int frac : {0, 7, 11}) {
      Config config;
      config.z_frac = frac;
      for (const int offset : {-1, 0, 1}) {
        FrameBuilder b(kWidth, kHeight);
        b.add(rectangle(0, 0, kWidth, kHeight), plane(9e6, slope), {1, 1, 1});
        b.add(rectangle(0, 0, kWidth, kHeight), plane(9e6 + offset, slope), {2, 2, 2});
        const auto p = draw(b.frame(), config);
        for (int x = 0; x < kWidth; ++x) REQUIRE(pixel(p, x, 0) == (offset < 0 ? 0x020202U : 0x010101U));
      }
    }
}

TEST_CASE("family 17: of coplanar polygons the first drawn is seen") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 50; ++round) {
    const ScreenPlane p = plane(random.real(1e6, 1.5e7), random.real(-1e4, 1e4), random.real(-1e4, 1e4), 40, 20);
    std::vector<std::uint8_t> order{10, 20, 30, 40};
    random.shuffle(order);
    FrameBuilder b(kWidth, kHeight);
    // The same rectangle, so that all spans have the same start.
    for (const std::uint8_t c : order) b.add(rectangle(10, 5, 80, 30), p, {c, c, c});
    const auto picture = draw(b.frame(), Config{});
    for (int y = 5; y < 30; ++y)
      for (int x = 10; x < 80; ++x) REQUIRE((pixel(picture, x, y) & 255U) == order[0]);
  }
}

TEST_CASE("family 18: planes further apart than the errors keep their order; crossing planes err only within them") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 60; ++round) {
    Config config;
    config.z_bits = random.in(8, 24);
    config.z_frac = random.in(0, 12);
    const double top = std::ldexp(1.0, config.z_bits) - 2;
    const double a = random.real(-1, 1) * top / kWidth / 4;
    const double c = random.real(0.4, 0.6) * top;
    // Twice (W + 1) 2^-(f+1), and 1 LSB for rounding to whole ones.
    const double apart = 2 * (kWidth + 1) * std::ldexp(1.0, -config.z_frac - 1) + 1;
    FrameBuilder b(kWidth, kHeight);
    b.add(rectangle(0, 0, kWidth, kHeight), plane(c + apart, a, 0, kWidth / 2, 0), {1, 1, 1});
    b.add(rectangle(random.in(0, 40), 0, kWidth, kHeight), plane(c, a, 0, kWidth / 2, 0), {2, 2, 2});
    if (c + apart + std::abs(a) * kWidth < top) {
      const auto p = draw(b.frame(), config);
      for (int x = 41; x < kWidth; ++x) REQUIRE(pixel(p, x, 0) == 0x020202U);
    }
    FrameBuilder crossing(kWidth, kHeight);
    for (int i = 0; i < 6; ++i)
      crossing.add(rectangle(random.in(0, 20), 0, random.in(70, kWidth), kHeight),
                   plane(c, random.real(-1, 1) * top / kWidth / 2, random.real(-1, 1) * top / kWidth / 2, kWidth / 2,
                         kHeight / 2));
    const Judgement j = judge(crossing.frame(), config);
    INFO(j.text());
    CHECK(j.good());
  }
}

TEST_CASE("family 19: colour from 0 to 255 and back is in range and monotone") {
  for (const int frac : {0, 4, 8, 16})
    for (const int channels : {1, 3}) {
      Config config;
      config.smooth = 1;
      config.color_frac = frac;
      config.channels = channels;
      for (const bool up : {true, false})
        for (const int width : {1, 2, 3, 17, kWidth}) {
          FrameBuilder b(kWidth, 1);
          b.add(rectangle(0, 0, width, 1), plane(1000));
          const double step = width > 1 ? 255.0 / (width - 1) : 0;
          b.frame().polygons[0].color_planes = 0;
          for (int c = 0; c < 3; ++c) b.frame().color_planes.push_back(plane(up ? 0 : 255, up ? step : -step));
          std::vector<std::uint32_t> words;
          make_frame(b.frame(), config, 0, words, {.threads = 1});
          check_frame(config, words, "test", 0);
          GoldenCore core(config);
          std::vector<std::uint8_t> p;
          core.frame(words, [&p](int, std::span<const std::uint8_t> line) { p.assign(line.begin(), line.end()); });
          CAPTURE(frac, channels, up, width);
          const auto at = [&](int x) {
            return int{p[static_cast<std::size_t>(x) * static_cast<std::size_t>(channels)]};
          };
          CHECK(at(0) == (up ? 0 : 255));
          for (int x = 1; x < width; ++x) REQUIRE((up ? at(x) >= at(x - 1) : at(x) <= at(x - 1)));
          // Half a step is rounding, the rest the slope's error: (k + 1) 2^-(f+1).
          if (width > 1) CHECK(std::abs(at(width - 1) - (up ? 255 : 0)) <= 0.5 + width * std::ldexp(1.0, -frac - 1));
        }
    }
}

}  // namespace kage::verif
