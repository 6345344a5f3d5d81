// SPDX-License-Identifier: Apache-2.0
// sdram_controller with a chip that checks its rules: random words and blocks against a map; how fast it reads and
// writes; and that the chip refuses what it should.
#include <cstdio>
#include <deque>
#include <type_traits>
#include <unordered_map>

#include "Vsdram.h"
#include "Vsdram_fast.h"
#include "Vsdram_hasty.h"
#include "Vsdram_late.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

constexpr std::uint32_t kBurst = 16;

template <class Model>
void start(Bench<Model>& top) {
  top->wr_valid_i = 0;
  top->req_valid_i = 0;
  for (int clock = 0; clock < 21000 && !top->ready_o; ++clock) top.edge();
  REQUIRE(top->ready_o);
}

/// Random words and blocks of `rows` rows in a few banks; what is read is what was written, if it was.
template <class Model>
void traffic(Dice& dice, int clocks) {
  Bench<Model> top(dice);
  start(top);
  Offer write(stall_percent(dice));
  Offer read(stall_percent(dice));
  std::unordered_map<std::uint32_t, std::uint32_t> memory;
  struct Word {
    bool known;
    std::uint32_t value;
  };
  std::deque<Word> expected;
  const auto bits = static_cast<int>(sizeof(top->wr_addr_i)) >= 4 ? 21 : 16;
  const std::uint32_t high = static_cast<std::uint32_t>(dice.bits(bits)) & ~0x7ffU;
  const bool runs = dice.percent(50);
  std::uint32_t run = 0;
  const auto place = [&] {
    return (high ^ static_cast<std::uint32_t>(dice.below(2)) << 14 ^ static_cast<std::uint32_t>(dice.below(2)) << 10) +
           static_cast<std::uint32_t>(dice.below(3)) * 256 + static_cast<std::uint32_t>(dice.below(32));
  };
  std::uint32_t address = place();
  std::uint32_t value = static_cast<std::uint32_t>(dice.bits(32));
  std::uint32_t block = place() / kBurst;
  int words = 0;
  for (int clock = 0; clock < clocks; ++clock) {
    top->wr_valid_i = write(dice, true) ? 1 : 0;
    top->wr_addr_i = address;
    top->wr_data_i = value;
    top->req_valid_i = read(dice, true) ? 1 : 0;
    top->req_block_i = block;
    top.settle();
    if (top->rd_valid_o) {
      REQUIRE_FALSE(expected.empty());
      if (expected.front().known) {
        REQUIRE(top->rd_data_o == expected.front().value);
        ++words;
      }
      expected.pop_front();
    }
    if (top->wr_valid_i && top->wr_ready_o) {
      memory[address] = value;
      write.taken();
      address = runs && ++run % 9 != 0 ? address + 1 : place();
      value = static_cast<std::uint32_t>(dice.bits(32));
    }
    if (top->req_valid_i && top->req_ready_o) {
      for (std::uint32_t i = 0; i < kBurst; ++i) {
        const auto found = memory.find(block * kBurst + i);
        expected.push_back(found == memory.end() ? Word{false, 0} : Word{true, found->second});
      }
      read.taken();
      block = place() / kBurst;
    }
    top.edge();
  }
  REQUIRE(top->lost_o == 0);
  if (clocks > 5000) REQUIRE(words > 100);
}

/// Megabytes a second at 100 MHz: of blocks one after another, or of words.
template <class Model>
double speed(Dice& dice, bool writes, std::uint32_t step) {
  Bench<Model> top(dice);
  start(top);
  constexpr int kClocks = 50000;
  std::uint32_t at = 0;
  int words = 0;
  for (int clock = 0; clock < kClocks; ++clock) {
    top->wr_valid_i = writes ? 1 : 0;
    top->req_valid_i = writes ? 0 : 1;
    top->wr_addr_i = at;
    top->req_block_i = at / kBurst;
    top.settle();
    if (top->rd_valid_o) ++words;
    if (top->wr_valid_i && top->wr_ready_o) ++words;
    if ((top->wr_valid_i && top->wr_ready_o) || (top->req_valid_i && top->req_ready_o)) at += step;
    top.edge();
  }
  return words * 4 * 100.0 / kClocks;
}

/// Clocks until the chip stops the simulation; -1 if it does not.
template <class Model>
int stopped(Dice& dice) {
  VerilatedContext context;
  context.fatalOnError(false);
  context.randReset(2);
  context.randSeed(static_cast<int>(dice.bits(30)) + 1);
  Model top(&context, "top");
  int clock = 0;
  top.wr_valid_i = 1;
  top.wr_addr_i = 0;
  top.wr_data_i = 0;
  top.req_valid_i = 0;
  top.req_block_i = 0;
  for (; clock < 3000 && !context.gotError() && !context.gotFinish(); ++clock) {
    top.rst_ni = clock >= 2 ? 1 : 0;
    top.clk_i = 0;
    top.eval();
    context.timeInc(5);
    top.clk_i = 1;
    top.eval();
    context.timeInc(5);
  }
  const bool error = context.gotError() || context.gotFinish();
  top.final();
  return error ? clock : -1;
}

}  // namespace

TEST_CASE("sdram_controller keeps what is written", "[sdram]") {
  each_seed(6, [](Dice& dice) { traffic<Vsdram>(dice, 40000); });
}
TEST_CASE("sdram_controller keeps it with other latencies, through more than one round of refreshes", "[sdram]") {
  each_seed(3, [](Dice& dice) { traffic<Vsdram_fast>(dice, 250000); });
}
TEST_CASE("sdram_controller is fast", "[sdram]") {
  each_seed(1, [](Dice& dice) {
    const double in_rows = speed<Vsdram>(dice, false, kBurst);
    const double across = speed<Vsdram>(dice, false, 1U << 10);
    const double written = speed<Vsdram>(dice, true, 1);
    std::printf(
        "sdram_controller at 100 MHz: blocks in a row %.1f MB/s, each in another row %.1f MB/s, words written %.1f "
        "MB/s\n",
        in_rows, across, written);
    REQUIRE(in_rows > 190);
    REQUIRE(across > 150);
    REQUIRE(written > 190);
  });
}
TEST_CASE("a chip stops a controller that is too hasty", "[sdram]") {
  each_seed(1, [](Dice& dice) {
    const int clock = stopped<Vsdram_hasty>(dice);
    REQUIRE(clock > 200);
    REQUIRE(clock < 400);
  });
}
TEST_CASE("rows that are refreshed too seldom lose their words", "[sdram]") {
  each_seed(1, [](Dice& dice) {
    Bench<Vsdram_late> top(dice);
    start(top);
    const auto write = [&](std::uint32_t address, std::uint32_t value) {
      top->wr_valid_i = 1;
      top->wr_addr_i = address;
      top->wr_data_i = value;
      top.settle();
      while (!top->wr_ready_o) top.edge();
      top.edge();
      top->wr_valid_i = 0;
    };
    const auto read = [&](std::uint32_t block) {
      top->req_valid_i = 1;
      top->req_block_i = block;
      top.settle();
      while (!top->req_ready_o) top.edge();
      top.edge();
      top->req_valid_i = 0;
      top.settle();
      while (!top->rd_valid_o) top.edge();
      const std::uint32_t first = top->rd_data_o;
      for (int i = 0; i < 40; ++i) top.edge();
      return first;
    };
    // Two rows: only the one that is near its turn lives.
    write(2000U << 10, 0x12345678);
    write(0, 1);
    REQUIRE(read(2000U << 6) == 0x12345678);
    write(0, 1);
    for (int i = 0; i < 300000; ++i) top.edge();
    REQUIRE(read(2000U << 6) == ~0x12345678U);
    REQUIRE(top->lost_o > 0);
  });
}
