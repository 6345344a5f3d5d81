// SPDX-License-Identifier: Apache-2.0
// Samples of a light, at the edges of what a counter holds, in the golden core. rtl/family_29_* has the same for the
// RTL.
#include "extremes/lights.hpp"
#include "kage/core.hpp"
#include "test/extremes/hold.hpp"

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

std::vector<std::uint8_t> line(const Config& c, const std::vector<LightSample>& samples,
                               const std::vector<std::uint32_t>& shares) {
  std::vector<std::uint8_t> pixels;
  const FrameStatus status = GoldenCore(c).frame(
      light_frame(c, kWidth, samples, shares),
      [&](int, std::span<const std::uint8_t> p) { pixels.insert(pixels.end(), p.begin(), p.end()); });
  REQUIRE(status.error == ErrorCode::NONE);
  return pixels;
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
        const std::vector<LightSample> samples(static_cast<std::size_t>(n), LightSample{7, 30, 0});
        // A share that tells any two counts apart.
        const std::uint32_t share = 65536U / 256;
        const auto pixels = line(c, samples, {share});
        for (int x = 0; x < kWidth; ++x) {
          const int counted = x >= 7 && x < 30 ? std::min(n, most) : 0;
          REQUIRE(pixels[static_cast<std::size_t>(x)] == (255 * (256 - counted) + 128) / 256);
          REQUIRE(pixels[static_cast<std::size_t>(x)] == light_pixel(c, x, samples, {share}));
        }
      }
  }
}

TEST_CASE(
    "family 29: samples in any order, lights among each other, give the same line, and each light its own count") {
  cases_hold<SamplesCase>(200);
}

}  // namespace kage::verif
