// SPDX-License-Identifier: Apache-2.0
// skid_buffer, stream_fifo and stream_register: order, capacity, stability, speed. ram_1r1w: what was written is read,
// and held.
#include <deque>

#include "Vram.h"
#include "Vskid.h"
#include "Vstream_fifo.h"
#include "Vstream_register.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

/// `through`: a place that becomes free is offered in the same clock.
template <class Model>
void stream_test(std::size_t capacity, bool through = false) {
  each_seed(20, [&](Dice& dice) {
    Bench<Model> top(dice);
    Offer offer(stall_percent(dice));
    const int out_stall = stall_percent(dice);
    std::deque<std::uint16_t> inside;
    std::uint16_t next = static_cast<std::uint16_t>(dice.bits(16));
    bool waited = false;
    int taken = 0;
    for (int clock = 0; clock < 400; ++clock) {
      top->in_valid_i = offer(dice, true) ? 1 : 0;
      top->in_data_i = next;
      top->out_ready_i = dice.percent(out_stall) ? 0 : 1;
      top.settle();
      REQUIRE(top->out_valid_o == (inside.empty() ? 0 : 1));  // latency is one clock: what is inside is offered
      if (top->out_valid_o) REQUIRE(top->out_data_o == inside.front());
      const bool freed = through && top->out_ready_i;
      REQUIRE(top->in_ready_o == (inside.size() < capacity || freed ? 1 : 0));  // all of the capacity, no more
      if (waited) REQUIRE(top->out_valid_o);
      waited = top->out_valid_o && !top->out_ready_i;
      const bool push = top->in_valid_i && top->in_ready_o;
      if (top->out_valid_o && top->out_ready_i) {
        inside.pop_front();
        ++taken;
      }
      if (push) {
        inside.push_back(next);
        next = static_cast<std::uint16_t>(dice.bits(16));
        offer.taken();
      }
      top.edge();
    }
    REQUIRE(taken > 5);
  });
}

template <class Model>
void full_speed_test() {
  each_seed(1, [](Dice& dice) {
    Bench<Model> top(dice);
    top->in_valid_i = 1;
    top->out_ready_i = 1;
    for (int clock = 0; clock < 50; ++clock) {
      top->in_data_i = static_cast<std::uint16_t>(clock);
      top.settle();
      REQUIRE(top->in_ready_o);
      if (clock > 0) {
        REQUIRE(top->out_valid_o);
        REQUIRE(top->out_data_o == clock - 1);
      }
      top.edge();
    }
  });
}

}  // namespace

TEST_CASE("skid_buffer keeps order and holds two", "[stream_cells]") { stream_test<Vskid>(2); }
TEST_CASE("skid_buffer passes a word a clock", "[stream_cells]") { full_speed_test<Vskid>(); }
TEST_CASE("stream_fifo keeps order and holds four", "[stream_cells]") {
  stream_test<Vstream_fifo>(parameter<Vstream_fifo>("DEPTH"));
}
TEST_CASE("stream_fifo passes a word a clock", "[stream_cells]") { full_speed_test<Vstream_fifo>(); }
TEST_CASE("stream_register keeps order and holds one", "[stream_cells]") { stream_test<Vstream_register>(1, true); }
TEST_CASE("stream_register passes a word a clock", "[stream_cells]") { full_speed_test<Vstream_register>(); }

TEST_CASE("ram_1r1w reads what was written, and holds it", "[stream_cells]") {
  each_seed(10, [](Dice& dice) {
    Bench<Vram> top(dice);
    constexpr int kWords = parameter<Vram>("WORDS");
    std::vector<int> words(kWords, -1);
    int held = -1;
    for (int clock = 0; clock < 600; ++clock) {
      const int write = dice.below(kWords);
      const int read = dice.below(kWords);
      top->wr_en_i = dice.percent(50) ? 1 : 0;
      top->wr_addr_i = static_cast<CData>(write);
      top->wr_data_i = static_cast<SData>(dice.bits(parameter<Vram>("BITS")));
      top->rd_en_i = dice.percent(50) ? 1 : 0;
      top->rd_addr_i = static_cast<CData>(read);
      if (top->rd_en_i) held = top->wr_en_i && write == read ? -1 : words[static_cast<std::size_t>(read)];
      if (top->wr_en_i) words[static_cast<std::size_t>(write)] = top->wr_data_i;
      top.edge();
      if (held >= 0) REQUIRE(top->rd_data_o == held);
    }
  });
}
