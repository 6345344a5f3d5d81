// SPDX-License-Identifier: Apache-2.0
//
// Shared parts of the tests of RTL modules: the driver of a module (drive.hpp), a seed that is printed and can be
// repeated (KAGE_SEED), and access to the fields of buses.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "drive.hpp"
#include "generated/buses.hpp"
#include "given.hpp"
#include "test/support/catch.hpp"

namespace kage::rtl {

inline std::uint64_t new_seed() {
  if (const char* fixed = std::getenv("KAGE_SEED")) return std::strtoull(fixed, nullptr, 0);
  return std::random_device{}();
}

/// Runs `body(dice)` for several seeds; a failure names the seed that repeats it.
template <class Body>
void each_seed(int rounds, Body body) {
  const std::uint64_t first = new_seed();
  for (int round = 0; round < (std::getenv("KAGE_SEED") != nullptr ? 1 : rounds); ++round) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(round);
    INFO("repeat with KAGE_SEED=" << seed);
    Dice dice(seed);
    body(dice);
  }
}

/// A field of a bus, of 64 bits at most.
template <class Port>
void put(Port& port, const Place& field, std::uint64_t value) {
  put(port, field.lsb, field.bits, value);
}
template <class Port>
std::uint64_t get(const Port& port, const Place& field) {
  return get(port, field.lsb, field.bits);
}

}  // namespace kage::rtl
