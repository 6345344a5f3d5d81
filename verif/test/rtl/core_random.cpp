// SPDX-License-Identifier: Apache-2.0
//
// The whole core against the golden core on random frames, sound and malformed: pixels, video framing, error registers
// and counts. Families 39 (stalls, back-to-back frames, one-pixel frames, empty lines, resets), 40 (damage at the port)
// and 41 (random initial state of every register and memory).
//
// usage: core_random MODEL.so... ; KAGE_SEED repeats a run, KAGE_ROUNDS sets its length. Exit 0: the same; 1: a
// difference, with the seed that repeats it; 2: trouble.
#include <cstdio>
#include <cstdlib>
#include <random>

#include "extremes/core_trial.hpp"
#include "kage/error.hpp"

int main(int argc, char** argv) try {
  using namespace kage::verif;
  const char* fixed = std::getenv("KAGE_SEED");
  const char* length = std::getenv("KAGE_ROUNDS");
  const int rounds = length != nullptr ? std::atoi(length) : 6;
  std::random_device device;
  for (int i = 1; i < argc; ++i) {
    const CoreModel model = load_core(argv[i]);
    const std::uint64_t base = fixed != nullptr ? std::strtoull(fixed, nullptr, 0) : device();
    for (int round = 0; round < (fixed != nullptr && length == nullptr ? 1 : rounds); ++round) {
      const std::uint64_t seed = base + static_cast<std::uint64_t>(round);
      CoreTrial trial(model, seed, seed);
      if (!trial.run()) {
        std::printf("%s: %s\nrepeat with KAGE_SEED=%llu\n", argv[i], trial.text().c_str(),
                    static_cast<unsigned long long>(seed));
        return 1;
      }
    }
    std::printf("%s: same, %d rounds from seed %llu\n", argv[i], rounds, static_cast<unsigned long long>(base));
  }
  return 0;
} catch (const kage::Error& e) {
  std::fprintf(stderr, "core_random: %s\n", e.what());
  return 2;
}
