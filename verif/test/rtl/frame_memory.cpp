// SPDX-License-Identifier: Apache-2.0
// block_memory and sdram_memory, which have the same ports: runs bring what was written before, however the clocks lie.
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <unordered_map>

#include "Vblock_memory.h"
#include "Vsdram_memory.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

/// A memory with the clock of its core: edge() is one of the core's, between which the memory's own come as its period
/// says.
class Block : public Bench<Vblock_memory> {
 public:
  static constexpr std::uint32_t kWords = 4096;
  static constexpr bool kExact = true;  // nothing is written in the clock of a read
  Block(Dice& dice, int /*core*/, int /*memory*/) : Bench(dice) {}
};

class Sdram {
 public:
  static constexpr std::uint32_t kWords = 1U << 23;
  /// Periods of the clocks in any unit.
  Sdram(Dice& dice, int core, int memory)
      : core_(core), memory_(memory), next_core_(dice.below(core)), next_memory_(dice.below(memory)) {
    context_.randReset(2);
    context_.randSeed(static_cast<int>(dice.bits(30)) + 1);
    top_ = std::make_unique<Vsdram_memory>(&context_, "top");
    top_->clk_i = 0;
    top_->mem_clk_i = 0;
    top_->rst_ni = 0;
    top_->mem_rst_ni = 0;
    top_->wr_valid_i = 0;
    top_->run_valid_i = 0;
    settle();
    for (int i = 0; i < 20; ++i) edge();
    top_->mem_rst_ni = 1;
    top_->rst_ni = 1;
    settle();
  }
  ~Sdram() {
    Verilated::threadContextp(&context_);
    top_->final();
    top_.reset();
  }
  Sdram(const Sdram&) = delete;
  Sdram& operator=(const Sdram&) = delete;
  Vsdram_memory* operator->() { return top_.get(); }
  void settle() { top_->eval(); }
  void edge() {
    for (; next_memory_ < next_core_; next_memory_ += memory_) pulse(false, true);
    const bool both = next_memory_ == next_core_;
    pulse(true, both);
    if (both) next_memory_ += memory_;
    next_core_ += core_;
  }

 private:
  void pulse(bool core, bool memory) {
    top_->clk_i = core ? 1 : 0;
    top_->mem_clk_i = memory ? 1 : 0;
    top_->eval();
    top_->clk_i = 0;
    top_->mem_clk_i = 0;
    top_->eval();
  }

  VerilatedContext context_;
  std::unique_ptr<Vsdram_memory> top_;
  std::int64_t core_, memory_, next_core_, next_memory_;
};

/// Runs while words are written. A word that is written while its run goes on may be read as it was when the run was
/// accepted, or as any since.
template <class Memory>
void runs_test(int rounds, int clocks) {
  int checked = 0;  // of all rounds: in one that writes seldom no run may meet what was written
  each_seed(rounds, [clocks, &checked](Dice& dice) {
    Memory top(dice, dice.between(3, 40), dice.between(3, 40));
    Offer write(stall_percent(dice));
    Offer run(stall_percent(dice));
    const int stall = stall_percent(dice);
    std::unordered_map<std::uint32_t, std::uint32_t> memory;
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> since;  // written since the run was accepted
    std::unordered_map<std::uint32_t, std::uint32_t> before;              // as it was when it was accepted
    const std::uint32_t base = (static_cast<std::uint32_t>(dice.bits(23)) & ~0xffU) % Memory::kWords;
    const bool at_end = dice.percent(30);
    const auto place = [&] {
      const auto within = static_cast<std::uint32_t>(dice.below(200));
      return ((at_end ? Memory::kWords - 100 : base) + within) % Memory::kWords;
    };
    std::uint32_t address = place(), value = static_cast<std::uint32_t>(dice.bits(32)), from = place();
    int words = dice.between(1, dice.percent(50) ? 3 : 90);
    std::uint32_t next = 0;
    int left = 0;
    bool waited = false;
    std::uint32_t waits = 0;
    for (int clock = 0; clock < clocks; ++clock) {
      top->wr_valid_i = write(dice, true) ? 1 : 0;
      top->wr_addr_i = address;
      top->wr_data_i = value;
      top->run_valid_i = run(dice, true) ? 1 : 0;
      top->run_addr_i = from;
      top->run_words_i = static_cast<SData>(words);
      top->rd_ready_i = dice.percent(stall) ? 0 : 1;
      top.settle();
      if (waited) REQUIRE((top->rd_valid_o && top->rd_data_o == waits));
      waited = top->rd_valid_o && !top->rd_ready_i;
      waits = top->rd_data_o;
      if (top->rd_valid_o && top->rd_ready_i) {
        REQUIRE(left > 0);
        const auto was = before.find(next);
        if (was != before.end()) {
          bool found = was->second == top->rd_data_o;
          for (const std::uint32_t other : since[next]) found = found || other == top->rd_data_o;
          REQUIRE(found);
          ++checked;
        }
        next = (next + 1) % Memory::kWords;
        --left;
      }
      const bool taken = top->wr_valid_i && top->wr_ready_o;
      if (taken) {
        memory[address] = value;
        since[address].push_back(value);
      }
      if (top->run_valid_i && top->run_ready_o) {
        REQUIRE(left == 0);
        before = memory;
        since.clear();
        next = from;
        left = words;
        run.taken();
        from = place();
        words = dice.between(1, dice.percent(50) ? 3 : 90);
      }
      if (taken) {
        write.taken();
        address = place();
        value = static_cast<std::uint32_t>(dice.bits(32));
      }
      top.edge();
    }
  });
  if (std::getenv("KAGE_SEED") == nullptr) REQUIRE(checked > 0);  // which repeats one round
}

/// Clocks of the core in which a long run comes, for each of its words.
template <class Memory>
double clocks_a_word(int core, int memory) {
  Dice dice(1);
  Memory top(dice, core, memory);
  constexpr int kWords = 20000;
  top->wr_valid_i = 0;
  top->run_valid_i = 1;
  top->run_addr_i = 5;
  top->run_words_i = kWords;
  top->rd_ready_i = 1;
  int words = 0, clocks = 0;
  for (; words < kWords && clocks < 200000; ++clocks) {
    top.settle();
    if (top->rd_valid_o) ++words;
    const bool accepted = top->run_ready_o != 0;
    top.edge();
    if (accepted) top->run_valid_i = 0;
  }
  REQUIRE(words == kWords);
  return static_cast<double>(clocks) / kWords;
}

}  // namespace

TEST_CASE("block_memory brings runs of what was written", "[frame_memory]") { runs_test<Block>(20, 4000); }
TEST_CASE("sdram_memory brings runs of what was written", "[frame_memory]") { runs_test<Sdram>(20, 6000); }
TEST_CASE("frame memories are fast", "[frame_memory]") {
  const double block = clocks_a_word<Block>(1, 1);
  const double slow = clocks_a_word<Sdram>(25, 10);   // a core of 40 MHz beside a memory of 100
  const double equal = clocks_a_word<Sdram>(10, 10);  // of the same clock, the memory's speed shows
  std::printf(
      "clocks a word: block_memory %.3f; sdram_memory %.3f at 40 MHz, %.3f at 100 MHz, with 100 MHz of the memory\n",
      block, slow, equal);
  REQUIRE(block < 1.01);
  REQUIRE(slow < 1.1);
  REQUIRE(equal < 2.6);
}
