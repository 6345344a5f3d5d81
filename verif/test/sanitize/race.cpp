// SPDX-License-Identifier: Apache-2.0
// A race of kage's own kind, on purpose: bodies of one loop over an arena count in one number without a lock. The
// thread sanitizer must say so (tools/test --threads): neither what it leaves out (not_ours.txt) nor what is suppressed
// (scheduler.txt) may hide it.
#include <tbb/blocked_range.h>

#include <cstddef>
#include <cstdio>

#include "arena/arena.hpp"

namespace {

std::size_t counted = 0;

void count_unlocked(std::size_t some) { counted += some; }

}  // namespace

int main() {
  kage::Arena arena(4);
  for (int round = 0; round < 100; ++round)
    arena.for_each(tbb::blocked_range<std::size_t>(0, 10000, 1),
                   [](const tbb::blocked_range<std::size_t>& some) { count_unlocked(some.size()); });
  std::printf("counted %zu\n", counted);
}
