// SPDX-License-Identifier: Apache-2.0
// compare_tree: the least key wins, on equal keys the lowest unit; under any stalls of any input and of the output; its
// latency and speed.
#include <deque>
#include <optional>

#include "Vcell.h"
#include "Vtree1.h"
#include "Vtree17.h"
#include "Vtree2.h"
#include "Vtree3.h"
#include "Vtree4.h"
#include "Vtree5.h"
#include "Vtree8.h"
#include "Vtree9.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

// All models have the same.
constexpr int kKeyBits = parameter<Vcell>("KEY_BITS"), kDataBits = parameter<Vcell>("DATA_BITS");

/// Clocks from a pixel's way in to its way out: the levels, and the buffers behind every second one but the last.
int latency(int units) {
  int levels = 0;
  while (1 << levels < units) ++levels;
  return levels + (levels > 0 ? (levels - 1) / 2 : 0);
}

struct Word {
  std::uint64_t data;
  bool last;
  bool operator==(const Word&) const = default;
  std::uint64_t key() const { return data >> (kDataBits - kKeyBits); }
};

/// `width` pixels for each unit: keys from few values, so that ties abound, and lines that are blank everywhere.
std::vector<std::vector<Word>> random_line(Dice& dice, int units, int width) {
  const int kinds = dice.percent(20) ? 1 : dice.between(2, 6);
  std::vector<std::vector<Word>> line(static_cast<std::size_t>(units));
  for (auto& unit : line) {
    const bool blank = dice.percent(30);
    for (int x = 0; x < width; ++x) {
      const std::uint64_t key = blank || kinds == 1 ? 63 : static_cast<std::uint64_t>(63 - dice.below(kinds));
      unit.push_back({key << (kDataBits - kKeyBits) | dice.bits(kDataBits - kKeyBits), x == width - 1});
    }
  }
  return line;
}

Word least(const std::vector<Word>& pixels) {
  Word best = pixels.front();
  for (const Word& w : pixels)
    if (w.key() < best.key()) best = w;
  return best;
}

template <class Model>
void random_test() {
  constexpr int units = parameter<Model>("UNITS");
  const auto n = static_cast<std::size_t>(units);
  each_seed(15, [&](Dice& dice) {
    Bench<Model> top(dice);
    const int out_stall = stall_percent(dice);
    std::vector<Offer> offers;
    std::vector<std::deque<Word>> in(n);
    for (std::size_t u = 0; u < n; ++u) offers.emplace_back(stall_percent(dice));
    std::deque<Word> expected;
    for (int i = 0; i < 20; ++i) {
      const auto line = random_line(dice, units, dice.between(1, 20));
      for (std::size_t x = 0; x < line[0].size(); ++x) {
        std::vector<Word> pixels;
        for (std::size_t u = 0; u < n; ++u) {
          pixels.push_back(line[u][x]);
          in[u].push_back(line[u][x]);
        }
        expected.push_back(least(pixels));
      }
    }
    std::optional<Word> waiting;
    while (!expected.empty()) {
      REQUIRE(top.clocks < 200000);
      for (int u = 0; u < units; ++u) {
        const auto& queue = in[static_cast<std::size_t>(u)];
        const bool on = offers[static_cast<std::size_t>(u)](dice, !queue.empty());
        put(top->in_valid_i, u, 1, on ? 1 : 0);
        put(top->in_data_i, u * kDataBits, kDataBits, on ? queue.front().data : dice.bits(kDataBits));
        put(top->in_last_i, u, 1, on ? queue.front().last : dice.bits(1));
      }
      top->out_ready_i = dice.percent(out_stall) ? 0 : 1;
      top.settle();
      const Word now{top->out_data_o, top->out_last_o != 0};
      if (waiting) {
        REQUIRE(top->out_valid_o);
        REQUIRE(now == *waiting);
      }
      if (top->out_valid_o) REQUIRE(now == expected.front());
      const bool out = top->out_valid_o && top->out_ready_i;
      waiting = top->out_valid_o && !out && units > 1 ? std::optional(now) : std::nullopt;
      const std::uint64_t taken = get(top->in_valid_i, 0, units) & get(top->in_ready_o, 0, units);
      top.edge();
      if (out) expected.pop_front();
      for (std::size_t u = 0; u < n; ++u) {
        if ((taken >> u & 1) == 0) continue;
        in[u].pop_front();
        offers[u].taken();
      }
    }
    for (const auto& queue : in) REQUIRE(queue.empty());  // none was left behind, none was taken twice
  });
}

template <class Model>
void speed_test() {
  constexpr int units = parameter<Model>("UNITS");
  each_seed(2, [&](Dice& dice) {
    Bench<Model> top(dice);
    const int width = 12;
    const auto line = random_line(dice, units, width);
    top->out_ready_i = 1;
    for (int clock = 0; clock < width + latency(units); ++clock) {
      for (int u = 0; u < units; ++u) {
        const Word w = clock < width ? line[static_cast<std::size_t>(u)][static_cast<std::size_t>(clock)] : Word{};
        put(top->in_valid_i, u, 1, clock < width ? 1 : 0);
        put(top->in_data_i, u * kDataBits, kDataBits, w.data);
        put(top->in_last_i, u, 1, w.last ? 1 : 0);
      }
      top.settle();
      if (clock < width) REQUIRE(get(top->in_ready_o, 0, units) == (1ULL << units) - 1);
      REQUIRE(top->out_valid_o == (clock >= latency(units) ? 1 : 0));
      if (top->out_valid_o) {
        std::vector<Word> pixels;
        pixels.reserve(line.size());
        for (const auto& unit : line) pixels.push_back(unit[static_cast<std::size_t>(clock - latency(units))]);
        REQUIRE(top->out_data_o == least(pixels).data);
      }
      top.edge();
    }
  });
}

}  // namespace

#define TREE_TEST(units)                                                                                        \
  TEST_CASE("compare_tree of " #units " units under stalls", "[compare_tree]") { random_test<Vtree##units>(); } \
  TEST_CASE("compare_tree of " #units " units, latency and speed", "[compare_tree]") { speed_test<Vtree##units>(); }
TREE_TEST(1)
TREE_TEST(2)
TREE_TEST(3)
TREE_TEST(4)
TREE_TEST(5)
TREE_TEST(8)
TREE_TEST(9)
TREE_TEST(17)

TEST_CASE("compare_cell takes both sides in one clock or none", "[compare_tree]") {
  each_seed(10, [](Dice& dice) {
    Bench<Vcell> top(dice);
    bool full = false;
    Word held{};
    for (int clock = 0; clock < 500; ++clock) {
      const bool last = dice.percent(20);
      Word left{dice.bits(kDataBits), last}, right{dice.bits(kDataBits), last};
      if (dice.percent(40)) right.data = (left.data & 0xFC00) | dice.bits(10);
      top->left_valid_i = dice.percent(70) ? 1 : 0;
      top->right_valid_i = dice.percent(70) ? 1 : 0;
      top->left_data_i = static_cast<SData>(left.data);
      top->right_data_i = static_cast<SData>(right.data);
      top->left_last_i = top->right_last_i = last ? 1 : 0;
      top->out_ready_i = dice.percent(60) ? 1 : 0;
      top.settle();
      const bool take = top->left_valid_i && top->right_valid_i && (!full || top->out_ready_i);
      REQUIRE(top->left_ready_o == (take ? 1 : 0));
      REQUIRE(top->right_ready_o == (take ? 1 : 0));
      REQUIRE(top->out_valid_o == (full ? 1 : 0));
      if (full) REQUIRE(Word{top->out_data_o, top->out_last_o != 0} == held);
      if (take) held = least({left, right});
      full = take || (full && !top->out_ready_i);
      top.edge();
    }
  });
}
