// SPDX-License-Identifier: Apache-2.0
//
// Family 29 on the whole core: as many equal samples as a counter holds, fewer, and more; samples in any order. The
// pixels are those that a formula says, not a model.
//
// usage: core_light MODEL.so... ; KAGE_SEED repeats a run. Exit 0: right; 1: a wrong pixel, with the seed; 2: trouble.
#include <cstdio>
#include <string>

#include "core_model.hpp"
#include "stimulus/random.hpp"
#include "extremes/light_frames.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

/// Frames of one core, each of one line: the second finds what the first has left.
constexpr int kFrames = 2;

/// Whether the model's lines are what light_pixel() says; prints the first pixel that is not.
bool right(const kage_rtl_table& api, const Config& c, std::uint64_t seed, int width,
           const std::vector<LightSample>& samples, const std::vector<std::uint32_t>& shares) {
  const auto words = light_frame(c, width, samples, shares);
  kage_rtl* m = api.create(seed);
  api.stalls(m, seed % 2 == 0 ? 65536 : 30000, seed % 3 == 0 ? 30000 : 65536, seed);
  for (int i = 0; i < kFrames; ++i) {
    api.expect(m, static_cast<std::uint32_t>(width), 1);
    api.submit(m, words.data(), words.size(), 1);
  }
  const int why = api.run(m, UINT64_MAX, 50'000'000);
  std::uint64_t count = 0;
  const std::uint8_t* pixels = api.pixels(m, &count);
  std::string wrong;
  if (why != KAGE_RTL_IDLE || count != static_cast<std::uint64_t>(kFrames) * static_cast<std::uint64_t>(width))
    wrong = "did not come to rest, or lost pixels";
  for (int i = 0; wrong.empty() && i < kFrames * width * c.channels; ++i) {
    const int expected = light_pixel(c, i / c.channels % width, samples, shares);
    if (pixels[i] != expected)
      wrong = "pixel " + std::to_string(i / c.channels) + " channel " + std::to_string(i % c.channels) + " is " +
              std::to_string(pixels[i]) + ", not " + std::to_string(expected);
  }
  api.destroy(m);
  if (!wrong.empty())
    std::printf("%zu samples: %s, KAGE_SEED=%llu\n", samples.size(), wrong.c_str(),
                static_cast<unsigned long long>(seed));
  return wrong.empty();
}

bool family_29(const kage_rtl_table& api, const Config& c, std::uint64_t seed) {
  Random random(seed);
  const int width = std::min(c.max_width, 40);
  const int most = (1 << c.count_bits) - 1;
  const int one = 1 << c.shade_frac;
  const auto lights = static_cast<std::size_t>(c.lights);
  for (const int n : {1, most, most + 1, 255}) {
    // A share at which the most that is counted leaves something, and a different one for each light.
    std::vector<std::uint32_t> shares(lights);
    for (auto& s : shares) s = static_cast<std::uint32_t>(random.in(1, std::max(1, one / (most + 1))));
    const std::vector<LightSample> equal(static_cast<std::size_t>(n),
                                         LightSample{width / 5, width * 3 / 4, random.in(0, c.lights - 1)});
    if (!right(api, c, seed, width, equal, shares)) return false;
    std::vector<LightSample> any;
    for (int i = 0; i < n; ++i) {
      const int xl = random.in(0, width);
      any.push_back({xl, random.in(xl, width), random.in(0, c.lights - 1)});
    }
    if (!right(api, c, seed + 1, width, any, shares)) return false;
    random.shuffle(any);
    if (!right(api, c, seed + 2, width, any, shares)) return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  bool good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    const rtl::CoreModel model = rtl::load_core("core_light", argv[i]);
    for (std::uint64_t seed = test_seed(); good && seed < test_seed() + 8; ++seed)
      good = family_29(model.api, model.config, seed);
    std::printf("%s: %s\n", argv[i], good ? "right" : "wrong");
  }
  return good ? 0 : 1;
}
