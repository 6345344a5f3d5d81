// SPDX-License-Identifier: Apache-2.0
//
// Chance for tests: seeded, printed, repeatable with KAGE_SEED.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>

namespace kage::verif {

/// The seed of this run: $KAGE_SEED, else `otherwise`. Tests print it when they fail.
inline std::uint64_t test_seed(std::uint64_t otherwise = 1) {
  const char* env = std::getenv("KAGE_SEED");
  return env != nullptr ? std::strtoull(env, nullptr, 0) : otherwise;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in low .. high, both included. Not std::uniform_int_distribution, whose outcome is the library's choice.
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % (static_cast<std::uint64_t>(high - low) + 1));
  }
  int in(int low, int high) { return static_cast<int>(integer(low, high)); }

  /// Uniform in [low, high).
  double real(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
  bool chance(double p) { return real(0, 1) < p; }

  template <class Container>
  void shuffle(Container& c) {
    for (std::size_t i = c.size(); i > 1; --i)
      std::swap(c[i - 1], c[static_cast<std::size_t>(integer(0, static_cast<std::int64_t>(i) - 1))]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace kage::verif
