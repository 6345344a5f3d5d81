// SPDX-License-Identifier: Apache-2.0
// Families 15 - 19: depth and colour along spans.
#include "extremes/depth.hpp"

#include <algorithm>
#include <cmath>

#include "extremes/screen.hpp"
#include "oracle/judge.hpp"
#include "stimulus/random.hpp"
#include "test/extremes/hold.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 96;
constexpr int kHeight = 40;

std::uint32_t pixel(const std::vector<std::uint32_t>& p, int x, int y) {
  return p[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
}

}  // namespace

TEST_CASE("family 15: the error after k pixels is at most (k + 1) 2^-(f+1), and no accumulator wraps") {
  // The bound is not idle, at the start of spans and at their ends.
  CHECK(cases_hold<RampCase>(20'000).share() > 0.99);
  CHECK(cases_hold<LongRampCase>(2'000).share() > 0.5);
}

TEST_CASE("family 15: a plane past either end is clamped, not wrapped") {
  for (const double slope : {-1e6, -1e5, 1e5, 1e6}) holds(PastEndCase{8e6, slope, 11});
  cases_hold<PastEndCase>(50);
}

TEST_CASE("family 16: depth that is whole at every pixel is stored as it is") {
  for (const int slope : {0, 1, -1, 1000, -1000, 65536})
    for (const int frac : {0, 7, 11})
      for (const int offset : {-1, 0, 1}) holds(WholeDepthCase{24, frac, 9'000'000, slope, offset});
  cases_hold<WholeDepthCase>(200);
}

TEST_CASE("family 17: of coplanar polygons the first drawn is seen") { cases_hold<CoplanarCase>(100); }

TEST_CASE("family 18: planes further apart than the errors keep their order; crossing planes err only within them") {
  cases_hold<ClosePlanesCase>(60);
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
    for (const bool grey : {false, true})
      for (const bool up : {true, false})
        for (const int width : {1, 2, 3, 17, kWidth})
          holds(ColourCase{frac, grey, width, up ? 0.0 : 255.0, up ? 255.0 : 0.0});
  cases_hold<ColourCase>(500);
}

}  // namespace kage::verif
