// SPDX-License-Identifier: Apache-2.0
// The smallest modules of rtl/board: crc32_words against zlib, synchronizer and reset_release against their latencies.
#include <zlib.h>

#include <array>
#include <deque>

#include "Vcrc32_words.h"
#include "Vreset_release16.h"
#include "Vreset_release4.h"
#include "Vsynchronizer.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

/// rst_no after clock t is high if good_i was at the CLOCKS + 1 clocks up to t - 2, and low otherwise.
template <class Model>
void reset_test() {
  constexpr int kClocks = parameter<Model>("CLOCKS");
  each_seed(20, [](Dice& dice) {
    Bench<Model> top(dice);
    REQUIRE(top->rst_no == 0);      // from power-up on, before any clock
    std::vector<bool> seen{false};  // good_i at each clock, from 1 on
    bool good = dice.percent(50);
    int left = dice.below(2 * kClocks), released = 0;
    for (int clock = 1; clock <= 60 * kClocks; ++clock) {
      if (left-- == 0) {
        good = !good;
        left = good || dice.percent(20) ? dice.below(2 * kClocks + 8) : dice.below(3);
      }
      top->good_i = good ? 1 : 0;
      top.edge();
      seen.push_back(good);
      const int first = clock - 2 - kClocks;
      // Before there are so many clocks, what the synchronizer began with may stand for two of them.
      if (first < 1 && clock > kClocks) continue;
      bool all = first >= 1;
      for (int at = first; all && at <= clock - 2; ++at) all = seen[static_cast<std::size_t>(at)];
      REQUIRE((top->rst_no == 1) == all);
      released += all;
    }
    REQUIRE(released > 0);
  });
}

}  // namespace

TEST_CASE("crc32_words is zlib's CRC-32 of words", "[board_cells]") {
  each_seed(20, [](Dice& dice) {
    Bench<Vcrc32_words> top(dice);
    const int stall = stall_percent(dice);
    std::deque<uLong> held{crc32(0, nullptr, 0), crc32(0, nullptr, 0)};  // after the last clock, and after this one
    int checked = 0;
    for (int clock = 0; clock < 300; ++clock) {
      top->clear_i = dice.percent(3) ? 1 : 0;
      top->word_i = dice.percent(stall) ? 0 : 1;
      top->data_i = static_cast<IData>(dice.bits(32));
      top.edge();
      uLong next = held.back();
      if (top->clear_i) {
        next = crc32(0, nullptr, 0);
        held = {next};  // what had come before is gone at once
      } else if (top->word_i) {
        const std::array<Bytef, 4> bytes{static_cast<Bytef>(top->data_i), static_cast<Bytef>(top->data_i >> 8),
                                         static_cast<Bytef>(top->data_i >> 16), static_cast<Bytef>(top->data_i >> 24)};
        next = crc32(next, bytes.data(), 4);
      }
      held.push_back(next);
      if (held.size() > 2) held.pop_front();
      REQUIRE(top->crc_o == held.front());  // a word shows two clocks after it came
      ++checked;
    }
    REQUIRE(checked == 300);
  });
}

TEST_CASE("synchronizer takes two clocks", "[board_cells]") {
  each_seed(10, [](Dice& dice) {
    Bench<Vsynchronizer> top(dice);
    std::deque<std::uint64_t> in{0, 0};  // reset leaves zeros
    REQUIRE(top->out_o == 0);
    for (int clock = 0; clock < 200; ++clock) {
      const bool reset = dice.percent(3);
      top->rst_ni = reset ? 0 : 1;
      top->in_i = static_cast<CData>(dice.bits(parameter<Vsynchronizer>("BITS")));
      in.push_back(top->in_i);
      top.edge();
      if (reset) in = {0, 0, 0};
      in.pop_front();
      REQUIRE(top->out_o == in.front());
    }
  });
}

TEST_CASE("reset_release holds for its clocks", "[board_cells]") {
  reset_test<Vreset_release4>();
  reset_test<Vreset_release16>();
}
