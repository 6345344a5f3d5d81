// SPDX-License-Identifier: Apache-2.0
//
// kage_top at its ports: a driver for them, and the tests that hold for every configuration.
#pragma once

#include <algorithm>
#include <vector>

#include "bench.hpp"
#include "kage/core.hpp"
#include "kage/registers.h"
#include "stimulus/frames.hpp"
#include "stimulus/polygon_frames.hpp"
#include "stimulus/random.hpp"

namespace kage::rtl {

/// A port that rests after each transfer for no clocks up to `most`; or for ever, if held.
struct Rest {
  int most = 0;
  bool held = false;
  int left = 0;
  bool over(Dice& dice, bool& resting) {  // asked once a clock, until it says yes
    if (held) return false;
    if (!resting) {
      left = dice.below(most + 1);
      resting = true;
    }
    return left-- <= 0;
  }
};

template <class Model>
class Core {
 public:
  explicit Core(Dice& dice) : dice_(dice), top(dice) { idle(); }

  /// A frame's words go in after those before it; what the golden core makes of them is expected.
  kage::FrameStatus submit(std::vector<std::uint32_t> words) {
    kage::GoldenCore golden(kConfig);
    const kage::FrameStatus status = golden.frame(words, [&](int, std::span<const std::uint8_t> line) {
      expected.insert(expected.end(), line.begin(), line.end());
    });
    words.resize((words.size() + beat() - 1) / beat() * beat());
    for (std::size_t i = 0; i < words.size(); ++i) {
      words_.push_back(words[i]);
      if ((i + 1) % beat() == 0) last_.push_back(i + 1 == words.size());
    }
    return status;
  }

  void clock() {
    if (!offered_) offered_ = beats_ < last_.size() && in.over(dice_, in_rests_);
    top->s_axis_tvalid_i = offered_ ? 1 : 0;
    if (offered_) {
      for (std::size_t i = 0; i < beat(); ++i)
        put(top->s_axis_tdata_i, 32 * static_cast<int>(i), 32, words_[beats_ * beat() + i]);
      top->s_axis_tlast_i = last_[beats_] ? 1 : 0;
    }
    const bool ready = out.over(dice_, out_rests_);
    if (ready) out_rests_ = false;
    top->m_axis_tready_i = ready ? 1 : 0;
    top.settle();
    const bool taken = offered_ && top->s_axis_tready_o;
    if (top->m_axis_tvalid_o && ready)
      for (int ch = 0; ch < kConfig.channels; ++ch)
        pixels.push_back(static_cast<std::uint8_t>(top->m_axis_tdata_o >> (8 * ch)));
    bites += top->irq_o && !bitten_ ? 1 : 0;
    bitten_ = top->irq_o;
    top.edge();
    if (taken) {
      offered_ = in_rests_ = false;
      ++beats_;
    }
  }

  void write(std::uint32_t address, std::uint32_t value) {
    top->s_axil_awvalid_i = top->s_axil_wvalid_i = top->s_axil_bready_i = 1;
    top->s_axil_awaddr_i = static_cast<CData>(address);
    top->s_axil_wdata_i = value;
    top->s_axil_wstrb_i = 15;
    clock();  // nothing was under way, so both are taken
    top->s_axil_awvalid_i = top->s_axil_wvalid_i = 0;
    for (int i = 0; i < 3; ++i) clock();
    top->s_axil_bready_i = 0;
  }

  std::uint32_t read(std::uint32_t address) {
    top->s_axil_arvalid_i = top->s_axil_rready_i = 1;
    top->s_axil_araddr_i = static_cast<CData>(address);
    clock();
    top->s_axil_arvalid_i = 0;
    top.settle();
    REQUIRE(top->s_axil_rvalid_o);  // a clock after its address
    const std::uint32_t value = top->s_axil_rdata_o;
    clock();
    top->s_axil_rready_i = 0;
    return value;
  }

  /// Clocks until all that was submitted has left, and some more.
  void finish() {
    for (int n = 0; (beats_ < last_.size() || pixels.size() < expected.size()); ++n) {
      REQUIRE(n < 1'000'000);
      clock();
    }
    for (int n = 0; n < 100; ++n) clock();
    REQUIRE(pixels == expected);
  }

  /// Reset for this number of clocks, with all ports at rest. Frames that were submitted and have not left are
  /// forgotten.
  void reset(int clocks) {
    idle();
    top->rst_ni = 0;
    for (int n = 0; n < clocks; ++n) {
      top.settle();
      top.edge();
    }
    top->rst_ni = 1;
    words_.clear();
    last_.clear();
    beats_ = 0;
    offered_ = in_rests_ = out_rests_ = bitten_ = false;
    pixels.clear();
    expected.clear();
  }

  [[nodiscard]] std::size_t beats_left() const { return last_.size() - beats_; }

  void idle() {
    top->s_axis_tvalid_i = top->s_axis_tlast_i = top->m_axis_tready_i = 0;
    top->s_axil_awvalid_i = top->s_axil_wvalid_i = top->s_axil_bready_i = 0;
    top->s_axil_arvalid_i = top->s_axil_rready_i = 0;
  }

 private:
  [[nodiscard]] std::size_t beat() const { return static_cast<std::size_t>(kConfig.beat_words); }

  static constexpr kage::Config kConfig = config_of<Model>();
  Dice& dice_;
  std::vector<std::uint32_t> words_;
  std::vector<bool> last_;  // a beat's TLAST
  std::size_t beats_ = 0;   // taken
  bool offered_ = false, in_rests_ = false, out_rests_ = false, bitten_ = false;

 public:
  Bench<Model> top;
  Rest in, out;
  std::vector<std::uint8_t> pixels, expected;
  int bites = 0;
};

/// A sound frame; for a core with a front end of polygons three times in four.
inline std::vector<std::uint32_t> frame(Dice& dice, const kage::Config& c, int width, int height) {
  kage::verif::Random random(dice.bits());
  std::vector<std::uint32_t> words;
  if (c.active > 0 && dice.percent(75))
    kage::verif::random_polygon_frame(random, c, width, height, words);
  else
    kage::verif::random_frame(random, c, width, height, words);
  return words;
}

template <class Model>
void reset_test() {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(10, [&](Dice& dice) {
    Core<Model> core(dice);
    Model& top = *core.top;
    // Somewhere in a frame, with all ports active: from the first clock of reset on nothing is ready.
    core.submit(frame(dice, c, c.max_width, 3));
    for (int n = dice.below(60); n > 0; --n) core.clock();
    top.rst_ni = 0;
    top.s_axis_tvalid_i = top.s_axil_awvalid_i = top.s_axil_wvalid_i = top.s_axil_arvalid_i = 1;
    for (int n = dice.between(1, 3); n > 0; --n) {
      core.top.settle();
      REQUIRE(!top.s_axis_tready_o);
      REQUIRE(!top.s_axil_awready_o);
      REQUIRE(!top.s_axil_wready_o);
      REQUIRE(!top.s_axil_arready_o);
      core.top.edge();
      REQUIRE(!top.m_axis_tvalid_o);
      REQUIRE(!top.s_axil_rvalid_o);
      REQUIRE(!top.s_axil_bvalid_o);
    }
    // A frame that is offered through reset is taken after it.
    Core<Model> fresh(dice);
    fresh.submit(frame(dice, c, dice.between(1, c.max_width), 2));
    fresh.top->rst_ni = 0;
    for (int n = 0; n < 3; ++n) fresh.clock();
    fresh.top->rst_ni = 1;
    fresh.finish();
    REQUIRE(fresh.read(KAGE_REG_FRAMES) == 1);
    REQUIRE(fresh.read(KAGE_REG_ERRORS) == 0);
  });
}

/// A reset in any clock of a frame leaves nothing of it: frames behind it come out as from a core that is new.
template <class Model>
void reset_within_test() {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(20, [&](Dice& dice) {
    Core<Model> core(dice);
    core.out.most = dice.percent(50) ? 7 : 0;
    for (int resets = 0; resets < 8; ++resets) {
      for (int n = 0; n < 2; ++n) core.submit(frame(dice, c, c.max_width, dice.between(1, 5)));
      for (int n = dice.below(dice.percent(50) ? 100 : 1500); n > 0; --n) core.clock();
      core.reset(dice.between(1, 3));
      if (dice.percent(30)) continue;
      core.submit(frame(dice, c, dice.between(1, c.max_width), 3));
      core.finish();
      REQUIRE(core.read(KAGE_REG_FRAMES) == 1);
      REQUIRE(core.read(KAGE_REG_ERRORS) == 0);
    }
  });
}

/// Ports that rest for at most S clocks never make a limit of S + 1 bite, whatever the core is doing.
template <class Model>
void healthy_test() {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(20, [&](Dice& dice) {
    static constexpr int kRests[] = {0, 0, 1, 2, 7, 40};
    const int most = kRests[dice.below(6)];
    CAPTURE(most);
    Core<Model> core(dice);
    const int sweep = dice.below(2) * 2 * c.max_width;
    for (int n = 0; n < sweep; ++n) core.clock();  // the sweep after reset is over, or is not
    core.write(KAGE_REG_WATCHDOG, static_cast<std::uint32_t>(most) + 1);
    core.write(KAGE_REG_CONTROL, KAGE_CONTROL_WATCHDOG_MASK);
    core.in.most = dice.percent(50) ? most : 0;
    core.out.most = dice.percent(50) ? most : 0;
    for (int n = 0; n < 12; ++n)
      core.submit(frame(dice, c, dice.percent(40) ? 1 : dice.between(1, c.max_width), dice.between(1, 5)));
    core.finish();
    REQUIRE(core.bites == 0);
    REQUIRE(core.read(KAGE_REG_FRAMES) == 12);
  });
}

/// A port that stops makes it bite, once, and nothing is lost when the port goes on.
template <class Model>
void standstill_test() {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(10, [&](Dice& dice) {
    const bool input = dice.percent(50);
    const int limit = dice.between(1, 50);
    CAPTURE(input, limit);
    Core<Model> core(dice);
    core.write(KAGE_REG_WATCHDOG, static_cast<std::uint32_t>(limit));
    core.write(KAGE_REG_CONTROL, KAGE_CONTROL_WATCHDOG_MASK);
    core.submit(frame(dice, c, c.max_width, 4));
    if (input) {
      const std::size_t rest = static_cast<std::size_t>(dice.between(1, static_cast<int>(core.beats_left()) - 1));
      while (core.beats_left() > rest) core.clock();
      core.in.held = true;
    } else {
      core.out.held = true;
    }
    REQUIRE(core.bites == 0);
    for (int n = 0; core.bites == 0; ++n) {
      REQUIRE(n < 100 * c.max_width + limit);  // all that the core can do by itself, and the limit
      if (input && n < limit) REQUIRE(core.bites == 0);
      core.clock();
    }
    const std::uint32_t waits =
        core.read(KAGE_REG_STATUS) & (KAGE_STATUS_WAITING_INPUT_MASK | KAGE_STATUS_WAITING_OUTPUT_MASK);
    if (input) REQUIRE(waits == KAGE_STATUS_WAITING_INPUT_MASK);
    if (!input) REQUIRE((waits & KAGE_STATUS_WAITING_OUTPUT_MASK) != 0);
    core.write(KAGE_REG_IRQ, KAGE_IRQ_WATCHDOG_MASK);
    for (int n = 0; n < 10 * limit + 100; ++n) core.clock();
    REQUIRE(core.bites == 1);
    core.in.held = core.out.held = false;
    core.finish();
    REQUIRE(core.bites == 1);
    REQUIRE(core.read(KAGE_REG_FRAMES) == 1);
  });
}

}  // namespace kage::rtl
