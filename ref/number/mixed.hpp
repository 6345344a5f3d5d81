// SPDX-License-Identifier: Apache-2.0
//
// Seeds that follow from others, yet have nothing in common with their neighbours (splitmix64).
#pragma once

#include <cstdint>

namespace kage {

/// 2^64 / golden ratio: multiples of it, modulo 2^64, are spread most evenly.
inline constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;

/// A number whose bits all depend on all bits of x.
constexpr std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 30U) * 0xBF58476D1CE4E5B9U;
  x = (x ^ x >> 27U) * 0x94D049BB133111EBU;
  return x ^ x >> 31U;
}

/// The seed of one in a series, a frame for example.
constexpr std::uint64_t mixed(std::uint64_t seed, std::uint64_t number) {
  return mixed(seed + (number + 1) * kGoldenRatio);
}

}  // namespace kage
