// SPDX-License-Identifier: Apache-2.0
// lane_ramp against its formula, clamp((start + (x - xl) * slope) >> FRAC, LO, HI), for groups one after the other and
// with pauses.
#include <algorithm>
#include <deque>

#include "Vlane_ramp1.h"
#include "Vlane_ramp32.h"
#include "Vlane_ramp4.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

struct Shape {
  int lanes, bits, frac, lo, hi, out_bits;
};

struct Span {
  std::uint64_t start, slope;
  int offset;
};

std::int64_t wrap(std::uint64_t v, int bits) { return static_cast<std::int64_t>(v << (64 - bits)) >> (64 - bits); }

template <class Model>
void ramp_test() {
  constexpr Shape s{parameter<Model>("LANES"), parameter<Model>("BITS"), parameter<Model>("FRAC"),
                    parameter<Model>("LO"),    parameter<Model>("HI"),   parameter<Model>("OUT_BITS")};
  int levels = 0;
  while (1 << levels < s.lanes) ++levels;
  each_seed(20, [&](Dice& dice) {
    Bench<Model> top(dice);
    // Groups the walker held, newest first; -1: none.
    struct Held {
      bool valid;
      Span span;
      int group;
    };
    std::deque<Held> history;
    std::deque<Span> staged(4);  // [k]: span in set-up stage k, [3] in the walker
    int stage_valid[3] = {0, 0, 0};
    Held walker{false, {}, 0};
    const int pause = stall_percent(dice) / 2;
    for (int clock = 0; clock < 400; ++clock) {
      // Elastic set-up as the parent does it.
      const bool step = walker.valid && dice.percent(40);
      const bool load = stage_valid[2] != 0 && !step && !dice.percent(pause);
      const bool en2 = stage_valid[2] == 0 || load;
      const bool en1 = stage_valid[1] == 0 || en2;
      const bool en0 = stage_valid[0] == 0 || en1;
      const bool offer = dice.percent(80);
      Span fresh{dice.bits(s.bits), dice.bits(dice.between(1, s.bits)), dice.below(s.lanes)};
      if (dice.percent(50))
        fresh.slope = static_cast<std::uint64_t>(-static_cast<std::int64_t>(fresh.slope)) & ((1ULL << s.bits) - 1);
      if (dice.percent(50)) fresh.start >>= 3;
      top->set_en_i = static_cast<CData>(en0 | en1 << 1 | en2 << 2);
      top->load_i = load ? 1 : 0;
      top->step_i = step ? 1 : 0;
      put(top->start_i, fresh.start);
      put(top->slope_i, fresh.slope);
      top->offset_i = static_cast<CData>(fresh.offset);

      if (load)
        walker = {true, staged[2], 0};
      else if (step)
        ++walker.group;
      if (en2) {
        staged[2] = staged[1];
        stage_valid[2] = stage_valid[1];
      }
      if (en1) {
        staged[1] = staged[0];
        stage_valid[1] = stage_valid[0];
      }
      if (en0) {
        staged[0] = fresh;
        stage_valid[0] = offer ? 1 : 0;
      }
      top.edge();
      history.push_front(walker);

      const auto age = static_cast<std::size_t>(levels) + 2;
      if (history.size() <= age || !history[age].valid) continue;
      const Held& h = history[age];
      for (int lane = 0; lane < s.lanes; ++lane) {
        const int dx = h.group * s.lanes + lane - h.span.offset;
        const std::int64_t sum =
            wrap(h.span.start + static_cast<std::uint64_t>(static_cast<std::int64_t>(dx)) * h.span.slope, s.bits);
        const std::int64_t expected = std::clamp<std::int64_t>(sum >> s.frac, s.lo, s.hi);
        REQUIRE(get(top->value_o, lane * s.out_bits, s.out_bits) == static_cast<std::uint64_t>(expected));
      }
    }
  });
}

}  // namespace

TEST_CASE("lane_ramp with one lane: depth of 24.11 bits", "[lane_ramp]") { ramp_test<Vlane_ramp1>(); }
TEST_CASE("lane_ramp with four lanes: colour of 8.8 bits", "[lane_ramp]") { ramp_test<Vlane_ramp4>(); }
TEST_CASE("lane_ramp with 32 lanes: depth of 12 bits, no fraction", "[lane_ramp]") { ramp_test<Vlane_ramp32>(); }
