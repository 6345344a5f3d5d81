// SPDX-License-Identifier: Apache-2.0
// lane_ramp against its formula, clamp((start + (x - xl) * slope) >> FRAC, LO, HI), for groups one after the other and
// with pauses.
#include <algorithm>
#include <array>
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

/// Groups of spans through the set-up, whose stages move as the parent moves them, and through the walker.
template <class Model>
class Ramp {
 public:
  explicit Ramp(Dice& dice) : dice_(dice), top_(dice), pause_(stall_percent(dice) / 2) {}

  void run() {
    for (int clock = 0; clock < 400; ++clock) {
      const Span fresh = drive();
      move(fresh);
      top_.edge();
      history_.push_front(walker_);
      look();
    }
  }

 private:
  static constexpr Shape kOf{parameter<Model>("LANES"), parameter<Model>("BITS"), parameter<Model>("FRAC"),
                             parameter<Model>("LO"),    parameter<Model>("HI"),   parameter<Model>("OUT_BITS")};

  static constexpr std::size_t kStages = kOf.lanes > 4 ? 2 : 1;  // of the set-up but the last

  /// A group that the walker held.
  struct Held {
    bool valid;
    Span span;
    int group;
  };

  Span random_span() {
    Span s{dice_.bits(kOf.bits), dice_.bits(dice_.between(1, kOf.bits)), dice_.below(kOf.lanes)};
    if (dice_.percent(50))
      s.slope = static_cast<std::uint64_t>(-static_cast<std::int64_t>(s.slope)) & ((1ULL << kOf.bits) - 1);
    if (dice_.percent(50)) s.start >>= 3;
    return s;
  }

  Span drive() {
    step_ = walker_.valid && dice_.percent(40);
    load_ = !queue_.empty() && !step_ && !dice_.percent(pause_);
    room_ = queue_.size() < 2;
    bool moves = room_;
    unsigned enables = 0;
    for (std::size_t k = kStages; k-- > 0;) {
      enabled_[k] = moves = !full_[k] || moves;
      enables |= static_cast<unsigned>(moves) << k;
    }
    offer_ = dice_.percent(80);
    const Span fresh = random_span();
    top_->set_en_i = static_cast<CData>(enables);
    top_->put_i = full_.back() ? 1 : 0;
    top_->load_i = load_ ? 1 : 0;
    top_->step_i = step_ ? 1 : 0;
    put(top_->start_i, fresh.start);
    put(top_->slope_i, fresh.slope);
    top_->offset_i = static_cast<CData>(fresh.offset);
    return fresh;
  }

  /// Moves the stages and the walker to their contents after this clock.
  void move(const Span& fresh) {
    if (load_) {
      walker_ = {true, queue_.front(), 0};
      queue_.pop_front();
    } else if (step_) {
      ++walker_.group;
    }
    if (full_.back() && room_) queue_.push_back(staged_.back());
    for (std::size_t k = kStages; --k > 0;) {
      if (!enabled_[k]) continue;
      staged_[k] = staged_[k - 1];
      full_[k] = full_[k - 1];
    }
    if (enabled_[0]) {
      staged_[0] = fresh;
      full_[0] = offer_;
    }
  }

  void look() {
    int levels = 0;
    while (1 << levels < kOf.lanes) ++levels;
    const auto age = static_cast<std::size_t>(levels) + 2;
    if (history_.size() <= age || !history_[age].valid) return;
    const Held& h = history_[age];
    for (int lane = 0; lane < kOf.lanes; ++lane) {
      const std::int64_t dx = h.group * kOf.lanes + lane - h.span.offset;
      const std::int64_t sum = wrap(h.span.start + static_cast<std::uint64_t>(dx) * h.span.slope, kOf.bits);
      const std::int64_t expected = std::clamp<std::int64_t>(sum >> kOf.frac, kOf.lo, kOf.hi);
      REQUIRE(get(top_->value_o, lane * kOf.out_bits, kOf.out_bits) == static_cast<std::uint64_t>(expected));
    }
  }

  Dice& dice_;
  Bench<Model> top_;
  int pause_;
  std::deque<Held> history_;             // newest first
  std::array<Span, kStages> staged_{};   // in each stage of the set-up but the last
  std::array<bool, kStages> full_{};     // whether it has one
  std::array<bool, kStages> enabled_{};  // whether it takes the one before it, this clock
  std::deque<Span> queue_;               // in the last stage
  Held walker_{false, {}, 0};
  bool step_ = false, load_ = false, room_ = false, offer_ = false;  // this clock
};

template <class Model>
void ramp_test() {
  each_seed(20, [](Dice& dice) { Ramp<Model>(dice).run(); });
}

}  // namespace

TEST_CASE("lane_ramp with one lane: depth of 24.11 bits", "[lane_ramp]") { ramp_test<Vlane_ramp1>(); }
TEST_CASE("lane_ramp with four lanes: colour of 8.8 bits", "[lane_ramp]") { ramp_test<Vlane_ramp4>(); }
TEST_CASE("lane_ramp with 32 lanes: depth of 12 bits, no fraction", "[lane_ramp]") { ramp_test<Vlane_ramp32>(); }
