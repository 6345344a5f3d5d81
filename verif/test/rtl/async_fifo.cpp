// SPDX-License-Identifier: Apache-2.0
// async_fifo between two clocks of any ratio and phase: order, capacity, latency, a word a clock of the slower side.
// A proof shows that it holds for bits caught while they change (verif/test/formal/async_fifo_proof.sv).
#include <deque>

#include "Vasync_fifo4.h"
#include "Vasync_fifo8.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

/// Both clocks in time: each has its period in picoseconds and its next edge, and edges that fall together come
/// together.
template <class Model>
class TwoClocks {
 public:
  TwoClocks(Dice& dice, long in_period, long out_period) : in_half_(in_period / 2), out_half_(out_period / 2) {
    context_.randReset(2);
    context_.randSeed(static_cast<int>(dice.bits(30)) + 1);
    top_ = std::make_unique<Model>(&context_, "top");
    in_at_ = 1 + dice.below(static_cast<int>(in_half_));
    out_at_ = 1 + dice.below(static_cast<int>(out_half_));
    top_->in_clk_i = 0;
    top_->out_clk_i = 0;
    top_->in_rst_ni = 0;
    top_->out_rst_ni = 0;
    top_->eval();
  }
  ~TwoClocks() {
    Verilated::threadContextp(&context_);
    top_->final();
    top_.reset();
  }
  TwoClocks(const TwoClocks&) = delete;
  TwoClocks& operator=(const TwoClocks&) = delete;

  Model* operator->() { return top_.get(); }
  struct Edges {
    bool in, out;  // rising ones
  };
  /// Goes to the next rising edge of either clock or of both. `before` sees the ports as the edge will.
  template <class Before>
  Edges step(Before before) {
    for (;;) {
      const long now = std::min(in_at_, out_at_);
      const bool in = in_at_ == now;
      const bool out = out_at_ == now;
      const Edges rising{in && !top_->in_clk_i, out && !top_->out_clk_i};
      if (rising.in || rising.out) {
        top_->eval();
        before(rising);
      }
      if (in) {
        top_->in_clk_i = !top_->in_clk_i;
        in_at_ += in_half_;
      }
      if (out) {
        top_->out_clk_i = !top_->out_clk_i;
        out_at_ += out_half_;
      }
      top_->eval();
      if (rising.in || rising.out) return rising;
    }
  }

 private:
  VerilatedContext context_;
  std::unique_ptr<Model> top_;
  long in_half_, out_half_, in_at_ = 0, out_at_ = 0;
};

template <class Model>
void random_ratios() {
  constexpr int kDepth = parameter<Model>("DEPTH");
  each_seed(60, [](Dice& dice) {
    // From 1 : 30 to 30 : 1, among them equal periods, where edges fall together or always at the same distance.
    const long in_period = dice.percent(20) ? 10000 : 2L * dice.between(500, 15000);
    const long out_period = dice.percent(20) ? in_period : 2L * dice.between(500, 15000);
    TwoClocks<Model> top(dice, in_period, out_period);
    Offer offer(stall_percent(dice));
    const int out_stall = stall_percent(dice);
    std::deque<std::uint16_t> inside;
    int in_clocks = 0, out_clocks = 0, left = 0, resets = 0;
    std::uint16_t next = 0;
    bool waited = false;
    // Both sides are reset at once, for three clocks of the slower one; each leaves at an edge of its own.
    auto reset = [&] {
      top->in_rst_ni = 0;
      top->out_rst_ni = 0;
      for (int in = 0, out = 0; in < 3 || out < 3;) {
        const auto edges = top.step([](auto) {});
        in += edges.in;
        out += edges.out;
      }
      inside.clear();
      waited = false;
    };
    reset();
    while (in_clocks < 400 || out_clocks < 400) {
      if (resets < 2 && dice.percent(1) && dice.percent(30)) {
        reset();
        ++resets;
      }
      const auto edges = top.step([&](auto rising) {
        if (rising.out) {
          REQUIRE((!waited || top->out_valid_o));
          if (top->out_valid_o) {
            REQUIRE(!inside.empty());
            REQUIRE(top->out_data_o == inside.front());
          }
          waited = top->out_rst_ni && top->out_valid_o && !top->out_ready_i;
          if (top->out_rst_ni && top->out_valid_o && top->out_ready_i) {
            inside.pop_front();
            ++left;
          }
        }
        if (rising.in && top->in_rst_ni && top->in_valid_i && top->in_ready_o) {
          inside.push_back(static_cast<std::uint16_t>(top->in_data_i));
          REQUIRE(inside.size() <= kDepth + 1);
          ++next;
          offer.taken();
        }
      });
      if (edges.in) {
        ++in_clocks;
        top->in_rst_ni = 1;
        top->in_valid_i = offer(dice, true);
        top->in_data_i = next;
      }
      if (edges.out) {
        ++out_clocks;
        top->out_rst_ni = 1;
        top->out_ready_i = !dice.percent(out_stall);
      }
    }
    REQUIRE(left > 5);
  });
}

/// A FIFO that never waits for the sake of its crossing passes a word a clock of the slower side.
template <class Model>
void full_speed() {
  for (const auto& [in_period, out_period] :
       {std::pair{10000L, 10000L}, {10000L, 7000L}, {7000L, 10000L}, {10000L, 1200L}, {1200L, 10000L}}) {
    Dice dice(1);
    TwoClocks<Model> top(dice, in_period, out_period);
    int slower = 0, left = 0, first = -1;
    top->in_valid_i = 1;
    top->out_ready_i = 1;
    for (int in = 0, out = 0; in < 3 || out < 3;) {
      const auto edges = top.step([](auto) {});
      in += edges.in;
      out += edges.out;
    }
    top->in_rst_ni = 1;
    top->out_rst_ni = 1;
    while (slower < 300) {
      top.step([&](auto rising) {
        if (in_period >= out_period ? rising.in : rising.out) ++slower;
        if (rising.out && top->out_valid_o) {
          ++left;
          if (first < 0) first = slower;
        }
      });
    }
    CAPTURE(in_period, out_period);
    REQUIRE(first <= 6);
    REQUIRE(left >= slower - first - 1);
  }
}

}  // namespace

TEST_CASE("async_fifo of 4 keeps order between clocks of any ratio", "[async_fifo]") { random_ratios<Vasync_fifo4>(); }
TEST_CASE("async_fifo of 8 keeps order between clocks of any ratio", "[async_fifo]") { random_ratios<Vasync_fifo8>(); }
TEST_CASE("async_fifo of 8 passes a word a clock of the slower side", "[async_fifo]") { full_speed<Vasync_fifo8>(); }
TEST_CASE("async_fifo of 4 fills", "[async_fifo]") {
  Dice dice(1);
  TwoClocks<Vasync_fifo4> top(dice, 10000, 9000);
  top->in_valid_i = 1;
  top->out_ready_i = 0;
  for (int i = 0; i < 8; ++i) top.step([](auto) {});
  top->in_rst_ni = 1;
  top->out_rst_ni = 1;
  int came = 0;
  for (int i = 0; i < 60; ++i) {
    top.step([&](auto rising) {
      if (rising.in && top->in_ready_o) ++came;
    });
  }
  REQUIRE(came == 5);  // DEPTH and the output's register
}
