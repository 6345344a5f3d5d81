// SPDX-License-Identifier: Apache-2.0
// Samples of a light, at the edges of what a counter holds.
#include <algorithm>
#include <numeric>

#include "catch.hpp"
#include "kage/core.hpp"
#include "kage/stream.hpp"
#include "support/random.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 40;

Config soft(int count_bits, int fsf) {
  Config c;
  c.channels = 1;
  c.shade_frac = 16;
  c.fsf = fsf;
  c.count_bits = count_bits;
  c.max_width = kWidth;
  return c;
}

/// The pixels in shadow of one sample.
struct Sample {
  int xl, xr, light;
};

void write_sample(TokenWriter& w, const Config& c, const Sample& s) {
  w.nc(s.xl, s.xr, 1);
  if (c.fsf != 0) w.ev(s.xl, s.xr);
  w.es(s.xl, s.xr, s.light);
}

/// A white lit line with these samples, of which each takes shares[light] of it.
std::vector<std::uint8_t> line(const Config& c, const std::vector<Sample>& samples,
                               const std::vector<std::uint32_t>& shares) {
  std::vector<std::uint32_t> words;
  TokenWriter w(c, words);
  w.header({kWidth, 1, 0, 0});
  if (c.class_bits == 1) w.shade(shares[0]);
  for (int light = 0; c.class_bits > 1 && light < c.lights; ++light) {
    const std::uint32_t share = shares[static_cast<std::size_t>(light)];
    w.table({1, light, {share, share, share}});
  }
  SpanToken span;
  span.xr = kWidth;
  span.z = std::int64_t{1000} << c.z_frac;
  span.normal_class = 1;
  span.color = {255, 255, 255};
  w.op(span);
  for (const Sample& s : samples) write_sample(w, c, s);
  if (!samples.empty()) w.resolve();
  w.eol(0);
  w.end();
  std::vector<std::uint8_t> pixels;
  const FrameStatus status = GoldenCore(c).frame(
      words, [&](int, std::span<const std::uint8_t> p) { pixels.insert(pixels.end(), p.begin(), p.end()); });
  REQUIRE(status.error == ErrorCode::NONE);
  return pixels;
}

/// 255 less `lost` of 2^16, rounded.
std::uint8_t white_less(std::uint64_t lost) {
  const std::uint64_t one = 1U << 16;
  return static_cast<std::uint8_t>((255 * (one - std::min(lost, one)) + one / 2) >> 16);
}

}  // namespace

TEST_CASE("family 29: N equal samples count 0 or N, up to what the counter holds, and not one past it") {
  for (const int bits : {1, 2, 5, 8}) {
    const int most = (1 << bits) - 1;
    for (const int fsf : {0, 1})
      for (const int n : {1, most - 1, most, most + 1, 255}) {
        if (n < 1) continue;
        CAPTURE(bits, fsf, n);
        const Config c = soft(bits, fsf);
        const std::vector<Sample> samples(static_cast<std::size_t>(n), Sample{7, 30, 0});
        // A share that tells any two counts apart.
        const std::uint32_t share = 65536U / 256;
        const auto pixels = line(c, samples, {share});
        for (int x = 0; x < kWidth; ++x) {
          const bool in = x >= 7 && x < 30;
          REQUIRE(pixels[static_cast<std::size_t>(x)] ==
                  white_less(in ? static_cast<std::uint64_t>(std::min(n, most)) * share : 0));
        }
      }
  }
}

TEST_CASE(
    "family 29: samples in any order, lights among each other, give the same line, and each light its own count") {
  Random random(test_seed(29));
  CAPTURE(test_seed(29));
  for (int round = 0; round < 200; ++round) {
    Config c = soft(random.in(2, 8), random.in(0, 1));
    c.class_bits = random.in(2, 11);
    c.lights = random.in(1, 8);
    const auto lights = static_cast<std::size_t>(c.lights);
    std::vector<std::uint32_t> shares(lights);
    for (auto& s : shares) s = static_cast<std::uint32_t>(random.in(0, 4000));
    std::vector<Sample> samples;
    for (int light = 0; light < c.lights; ++light)
      for (int n = random.in(0, (1 << c.count_bits) - 1); n > 0; --n) {
        const int xl = random.in(0, kWidth);
        samples.push_back({xl, random.in(xl, kWidth), light});
      }
    const auto pixels = line(c, samples, shares);
    for (int x = 0; x < kWidth; ++x) {
      std::uint64_t lost = 0;
      for (const Sample& s : samples)
        if (x >= s.xl && x < s.xr) lost += shares[static_cast<std::size_t>(s.light)];
      REQUIRE(pixels[static_cast<std::size_t>(x)] == white_less(lost));
    }
    random.shuffle(samples);
    REQUIRE(line(c, samples, shares) == pixels);
  }
}

}  // namespace kage::verif
