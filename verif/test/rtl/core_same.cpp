// SPDX-License-Identifier: Apache-2.0
//
// Family 12: models that share all parameters which affect pixels, and nothing else, give the same pixels for the same
// words, the golden core's, whatever their arrangement, LANES, BEAT_WORDS and stalls.
//
// usage: core_same MODEL.so MODEL.so... ; KAGE_SEED repeats a run, KAGE_ROUNDS sets its length, five frames a round.
// Exit 0: the same; 1: a difference, with the seed; 2: trouble.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "extremes/rtl_cases.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/random.hpp"

int main(int argc, char** argv) try {
  using namespace kage;
  using verif::CoreModel;
  std::vector<CoreModel> models;
  for (int i = 1; i < argc; ++i) models.push_back(verif::load_core(argv[i]));
  if (models.size() < 2) {
    std::fprintf(stderr, "usage: core_same MODEL.so MODEL.so...\n");
    return 2;
  }
  int width = models[0].config.max_width;
  for (const CoreModel& l : models) {
    width = std::min(width, l.config.max_width);
    if (param_hash(l.config) != param_hash(models[0].config)) {
      std::fprintf(stderr, "core_same: %s: parameters that affect pixels differ from those of %s\n", l.path.c_str(),
                   models[0].path.c_str());
      return 2;
    }
  }
  const char* length = std::getenv("KAGE_ROUNDS");
  const std::uint64_t frames = 5 * static_cast<std::uint64_t>(length != nullptr ? std::atoi(length) : 10);
  std::size_t compared = 0;
  for (std::uint64_t seed = verif::test_seed(); seed < verif::test_seed() + frames; ++seed) {
    verif::Random random(seed);
    std::vector<std::uint32_t> words;
    verif::random_frame(random, models[0].config, random.in(1, width), random.in(1, 6), words);
    std::vector<std::uint8_t> expected;
    GoldenCore(models[0].config).frame(words, [&](int, std::span<const std::uint8_t> line) {
      expected.insert(expected.end(), line.begin(), line.end());
    });
    for (std::size_t i = 0; i < models.size(); ++i) {
      std::string wrong = "and the golden core differ";
      if (verif::rtl_pixels(models[i], words, seed + i, wrong) != expected) {
        std::printf("%s %s, KAGE_SEED=%llu\n", models[i].path.c_str(), wrong.c_str(),
                    static_cast<unsigned long long>(seed));
        return 1;
      }
      compared += expected.size();
    }
  }
  std::printf("same: %zu models, %zu bytes of pixels compared\n", models.size(), compared);
  return compared > 0 ? 0 : 1;
} catch (const kage::Error& e) {
  std::fprintf(stderr, "core_same: %s\n", e.what());
  return 2;
}
