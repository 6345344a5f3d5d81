// SPDX-License-Identifier: Apache-2.0
//
// Family 12: models that share all parameters which affect pixels, and nothing else, give the same pixels for the same
// words, the golden core's, whatever their arrangement, LANES, BEAT_WORDS and stalls.
//
// usage: core_same MODEL.so MODEL.so... ; KAGE_SEED repeats a run. Exit 0: the same; 1: a difference, with the seed; 2:
// trouble.
#include <algorithm>
#include <cstdio>
#include <vector>

#include "core_model.hpp"
#include "kage/config.hpp"
#include "kage/core.hpp"
#include "stimulus/frames.hpp"
#include "stimulus/random.hpp"

namespace {

using namespace kage;
using rtl::CoreModel;
using rtl::load_core;

std::vector<std::uint8_t> pixels_of(const CoreModel& l, const std::vector<std::uint32_t>& words, std::uint64_t seed) {
  kage_rtl* m = l.api.create(seed);
  verif::Random random(seed);
  l.api.stalls(m, static_cast<std::uint32_t>(random.in(8000, 65536)),
               static_cast<std::uint32_t>(random.in(8000, 65536)), seed);
  const FrameHeader h = FrameHeader::read(words);
  l.api.expect(m, static_cast<std::uint32_t>(h.width), static_cast<std::uint32_t>(h.height));
  l.api.submit(m, words.data(), words.size(), 1);
  if (l.api.run(m, UINT64_MAX, 50'000'000) != KAGE_RTL_IDLE) {
    std::printf("%s did not come to rest, seed %llu\n", l.path, static_cast<unsigned long long>(seed));
    std::exit(1);
  }
  std::uint64_t count = 0;
  const std::uint8_t* data = l.api.pixels(m, &count);
  std::vector<std::uint8_t> pixels(data, data + count * static_cast<std::uint64_t>(l.config.channels));
  l.api.destroy(m);
  return pixels;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<CoreModel> models;
  for (int i = 1; i < argc; ++i) models.push_back(load_core("core_same", argv[i]));
  if (models.size() < 2) {
    std::fprintf(stderr, "usage: core_same MODEL.so MODEL.so...\n");
    return 2;
  }
  int width = models[0].config.max_width;
  for (const CoreModel& l : models) {
    width = std::min(width, l.config.max_width);
    if (param_hash(l.config) != param_hash(models[0].config)) {
      std::fprintf(stderr, "core_same: %s: parameters that affect pixels differ from those of %s\n", l.path,
                   models[0].path);
      return 2;
    }
  }
  std::size_t compared = 0;
  for (std::uint64_t seed = verif::test_seed(); seed < verif::test_seed() + 150; ++seed) {
    verif::Random random(seed);
    std::vector<std::uint32_t> words;
    verif::random_frame(random, models[0].config, random.in(1, width), random.in(1, 6), words);
    std::vector<std::uint8_t> expected;
    GoldenCore(models[0].config).frame(words, [&](int, std::span<const std::uint8_t> line) {
      expected.insert(expected.end(), line.begin(), line.end());
    });
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (pixels_of(models[i], words, seed + i) != expected) {
        std::printf("%s and the golden core differ, KAGE_SEED=%llu\n", models[i].path,
                    static_cast<unsigned long long>(seed));
        return 1;
      }
      compared += expected.size();
    }
  }
  std::printf("same: %zu models, %zu bytes of pixels compared\n", models.size(), compared);
  return compared > 0 ? 0 : 1;
}
