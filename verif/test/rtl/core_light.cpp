// SPDX-License-Identifier: Apache-2.0
//
// Family 29 on the whole core: as many equal samples as a counter holds, fewer, and more; samples in any order. The
// pixels are those that a formula says, not a model.
//
// usage: core_light MODEL.so... ; KAGE_SEED repeats a run. Exit 0: right; 1: a wrong pixel, with the seed; 2: trouble.
#include <algorithm>
#include <cstdio>

#include "extremes/rtl_cases.hpp"
#include "kage/error.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

/// Whether the model's lines are right; prints what is not.
bool right(const CoreModel& model, std::uint64_t seed, int width, const std::vector<LightSample>& samples,
           const std::vector<std::uint32_t>& shares) {
  const std::string wrong = light_line_wrong(model, seed, width, samples, shares);
  if (!wrong.empty())
    std::printf("%zu samples: %s, KAGE_SEED=%llu\n", samples.size(), wrong.c_str(),
                static_cast<unsigned long long>(seed));
  return wrong.empty();
}

bool family_29(const CoreModel& model, std::uint64_t seed) {
  const Config& c = model.config;
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
    if (!right(model, seed, width, equal, shares)) return false;
    std::vector<LightSample> any;
    for (int i = 0; i < n; ++i) {
      const int xl = random.in(0, width);
      any.push_back({xl, random.in(xl, width), random.in(0, c.lights - 1)});
    }
    if (!right(model, seed + 1, width, any, shares)) return false;
    random.shuffle(any);
    if (!right(model, seed + 2, width, any, shares)) return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) try {
  bool good = argc > 1;
  for (int i = 1; i < argc; ++i) {
    const CoreModel model = load_core(argv[i]);
    for (std::uint64_t seed = test_seed(); good && seed < test_seed() + 8; ++seed) good = family_29(model, seed);
    std::printf("%s: %s\n", argv[i], good ? "right" : "wrong");
  }
  return good ? 0 : 1;
} catch (const kage::Error& e) {
  std::fprintf(stderr, "core_light: %s\n", e.what());
  return 2;
}
