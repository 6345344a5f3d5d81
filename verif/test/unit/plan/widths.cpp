// SPDX-License-Identifier: Apache-2.0
// The inequalities behind a plan's widths, against every case that they speak of.
#include "plan/widths.hpp"

#include <rapidcheck.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <vector>

#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::plan;

namespace {

using Rational = boost::multiprecision::cpp_rational;
using boost::multiprecision::cpp_int;

/// The greatest whole number that is not above.
int floor_of(const Rational& r) {
  cpp_int q = numerator(r) / denominator(r);
  if (r < 0 && Rational(q) != r) q -= 1;
  return static_cast<int>(q);
}

/// RESOLVE with fractions without end.
int darkened(int color, const Rational& share) {
  const Rational left = share > 1 ? Rational(0) : Rational(1) - share;
  return floor_of(color * left + Rational(1, 2));
}

/// RESOLVE as docs/stream.md has it.
int darkened(int color, std::int64_t shade, int frac) {
  const std::int64_t whole = std::int64_t{1} << frac;
  const std::int64_t left = std::max<std::int64_t>(whole - shade, 0);
  return static_cast<int>((color * left + (whole >> 1)) >> frac);
}

}  // namespace

TEST_CASE("colours are shown within the bound for every colour, state of shadow and share") {
  rc::check("shown_error()", [] {
    const int frac = *rc::gen::inRange(1, 17);
    const int lights = *rc::gen::inRange(1, 4);
    const int drawn = *rc::gen::inRange(0, 3);  // whole steps by which colours differ before
    ShareGroup group;
    for (int l = 0; l < lights; ++l)
      group.shares.push_back({*rc::gen::inRange<std::uint32_t>(1, 65537), *rc::gen::inRange(1, 12)});
    const double bound = shown_error(drawn, std::vector{group}, frac);
    for (int trial = 0; trial < 40; ++trial) {
      Rational share = 0;
      std::int64_t shade = 0;
      for (const Share& s : group.shares) {
        const int count = *rc::gen::inRange(0, s.samples + 1);
        share += Rational(s.value * static_cast<std::uint32_t>(count), 65536);
        // The share of SHADE_FRAC bits, rounded half up.
        shade += std::int64_t{count} * ((std::int64_t{s.value} * (std::int64_t{1} << frac) + 32768) >> 16);
      }
      const int color = *rc::gen::inRange(0, 256);
      const int other = std::clamp(color + *rc::gen::inRange(-drawn, drawn + 1), 0, 255);
      const int off = std::abs(darkened(color, share) - darkened(other, shade, frac));
      RC_ASSERT(off <= std::ceil(bound));
    }
  });
}

TEST_CASE("the bound of what is shown is met by some colour") {
  // Half of a colour: exact with one bit. A third with one bit is a half: 255 colours differ by up to 255/6.
  const ShareGroup half{{{32768, 1}}, {}};
  CHECK(shown_error(0, std::vector{half}, 1) < 0.01);
  const ShareGroup third{{{21845, 1}}, {}};
  CHECK(shown_error(0, std::vector{third}, 1) > 42);
  CHECK(std::abs(darkened(255, Rational(1, 3)) - darkened(255, 1, 1)) == 42);
}

TEST_CASE("depth's bound holds along spans of any slope, and is met within a tenth") {
  double worst = 0;
  for (const int frac : {0, 1, 4, 8}) {
    const int pixels = 300;
    const double bound = depth_error(pixels, frac, 300, 200);
    for (int n = 1; n < 4000; n += 7) {
      // Z = start + slope k, both far from what fractions hold: start + 1/3, slope n/8191.
      const double start = 1000 + 1.0 / 3;
      const double slope = n / 8191.0;
      const double unit = std::ldexp(1.0, frac);
      const double z = std::floor(start * unit + 0.5) + (frac > 0 ? unit / 2 : 0);
      const double dz = std::floor(slope * unit + 0.5);
      for (int k = 0; k < pixels; ++k) {
        const double off = std::abs(std::floor((z + dz * k) / unit) - (start + slope * k));
        CHECK(off <= bound);
        worst = std::max(worst, off / bound);
      }
    }
  }
  CHECK(worst > 0.9);
}

TEST_CASE("steps are the stated ones") {
  CHECK(position_step(1) == 8);
  CHECK(position_step(9) == 11);
  CHECK(position_step(12) == 12);
  CHECK(position_step(13) == 15);
  CHECK(position_step(16) == 16);
  CHECK(four_step(21) == 24);
  CHECK(four_step(24) == 24);
  CHECK(class_step(5) == 8);
  CHECK(width_step(641) == 1280);
  CHECK(width_step(1280) == 1280);
}
