// SPDX-License-Identifier: Apache-2.0
//
// Tests on every instruction set: all that this build and this CPU have, or the one that KAGE_SIMD names alone.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "simd/targets.hpp"

namespace kage::verif {

inline std::vector<simd::Target> tested_targets() {
  const char* const only = std::getenv("KAGE_SIMD");
  if (only != nullptr && *only != '\0') return {simd::in_use()};
  return simd::available();
}

/// Calls test(target), a simd::Target, with kernels running on each in turn; then all is as it was.
template <class Test>
void on_every_target(Test test) {
  struct Restore {
    simd::Target before = simd::in_use();
    ~Restore() { simd::use(before); }
  } const restore;
  for (const simd::Target& target : tested_targets()) {
    simd::use(target);
    test(target);
  }
}

/// Vectors of kernels have at most so many lanes of 32 bits. Sizes from 0 to three of them go through all that a loop
/// over vectors can do: none, one, some, each with and without a rest.
inline constexpr int kMostLanes = 16;
inline constexpr int kMostSize = 3 * kMostLanes;

}  // namespace kage::verif
