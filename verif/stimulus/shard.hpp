// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "kage/error.hpp"

namespace kage::verif {

/// The part `number` (1 to of) of `of` parts of a list: neighbours, which need the same models. Where there are more
/// parts than elements, some parts have the same one: none is empty.
struct Shard {
  unsigned number = 1, of = 1;
  /// Whether it has the element `index`, from 0 on, of a list of `count`.
  [[nodiscard]] bool has(std::size_t index, std::size_t count) const {
    return count < of ? (number - 1) * count / of == index : index * of / count == number - 1;
  }
};

/// $KAGE_SHARD, "I/N", for a run that has no time for all; without it, all. Throws Error if it is something else.
inline Shard test_shard() {
  const char* env = std::getenv("KAGE_SHARD");
  if (env == nullptr) return {};
  Shard shard;
  int end = 0;
  if (std::sscanf(env, "%u/%u%n", &shard.number, &shard.of, &end) != 2 || env[end] != '\0' || shard.number < 1 ||
      shard.number > shard.of)
    throw Error(fmt::format("KAGE_SHARD={}: not I/N with I from 1 to N", env));
  return shard;
}

}  // namespace kage::verif
