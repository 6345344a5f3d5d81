// SPDX-License-Identifier: Apache-2.0
// tmds_encoder, dvi_encoder and tmds_shifter, against a receiver that was written from the standard's decoder.
#include <bit>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "Vdvi_link.h"
#include "Vtmds_encoder.h"
#include "bench.hpp"
#include "board/dvi_receiver.hpp"

using namespace kage::rtl;
using kage::board::DviReceiver;
using kage::board::tmds_decode;
using kage::board::TmdsSymbol;
using kage::board::VideoPixel;

namespace {

// An encoder with what a receiver keeps: ones less zeros since blanking.
class Encoder {
 public:
  explicit Encoder(Dice& dice) : top_(dice) {}

  /// The word of what was given two clocks ago; so two more clocks are needed for what is given.
  unsigned clock(bool active, unsigned data, unsigned control = 0) {
    top_->active_i = active ? 1 : 0;
    top_->data_i = static_cast<CData>(data);
    top_->control_i = static_cast<CData>(control);
    top_.edge();
    return top_->word_o;
  }
  /// The word of one value behind `before`, from blanking on; and the disparity after each.
  unsigned word_behind(const std::vector<unsigned>& before, unsigned value) {
    clock(false, 0);
    for (const unsigned v : before) clock(true, v);
    clock(true, value);
    return clock(false, 0);
  }

 private:
  Bench<Vtmds_encoder> top_;
};

int disparity(unsigned word) { return 2 * std::popcount(word) - 10; }

void check_word(unsigned word, unsigned value, int before) {
  const TmdsSymbol symbol = tmds_decode(word);
  INFO("value " << value << " at disparity " << before << " is " << word);
  REQUIRE(symbol.valid);
  REQUIRE_FALSE(symbol.control);
  REQUIRE(symbol.value == value);
  REQUIRE(std::popcount((word ^ word >> 1) & 0x7F) <= 3);
  const int after = before + disparity(word);
  REQUIRE(std::abs(after) <= DviReceiver::kMaxDisparity);
  // As the standard says: the eight bits lean against the disparity, where both are there.
  const int lean = 2 * std::popcount(word & 0xFF) - 8;
  if (before != 0 && lean != 0) REQUIRE((lean > 0) != (before > 0));
}

// Five edges of the fast clock to one of the pixels'. `skew` puts the pixel's edge before (-1), at (0) or behind (1)
// that of the fast clock, as far as a clock tree may.
class Link {
 public:
  Link(Dice& dice, int skew) : skew_(skew) {
    context_.randReset(2);
    context_.randSeed(static_cast<int>(dice.bits(30)) + 1);
    top_ = std::make_unique<Vdvi_link>(&context_, "top");
    top_->rst_ni = 0;
    for (int i = 0; i < 4; ++i) pixel({});
    top_->rst_ni = 1;
  }
  ~Link() {
    Verilated::threadContextp(&context_);
    top_->final();
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  std::optional<VideoPixel> pixel(const VideoPixel& in) {
    std::optional<VideoPixel> out;
    top_->active_i = in.active ? 1 : 0;
    top_->hsync_i = in.hsync ? 1 : 0;
    top_->vsync_i = in.vsync ? 1 : 0;
    top_->rgb_i = in.rgb;
    for (int step = 0; step < 5; ++step) {
      const CData high = step < 2 ? 1 : 0;
      if (skew_ < 0) {
        top_->clk_i = high;
        top_->eval();
      }
      if (skew_ == 0) top_->clk_i = high;
      top_->bit_clk_i = 1;
      top_->eval();
      if (skew_ > 0) {
        top_->clk_i = high;
        top_->eval();
      }
      const unsigned pairs = top_->pairs_o;
      for (int half = 0; half < 2; ++half) {
        const unsigned bits = pairs >> half;
        const auto got =
            receiver.put((bits & 1) != 0, (bits >> 2 & 1) != 0, (bits >> 4 & 1) != 0, (bits >> 6 & 1) != 0);
        if (got) out = got;
      }
      top_->bit_clk_i = 0;
      top_->eval();
    }
    return out;
  }

  DviReceiver receiver;

 private:
  int skew_;
  VerilatedContext context_;
  std::unique_ptr<Vdvi_link> top_;
};

// The view of `in` at a link's other end: syncs hold while colour is sent, since nothing carries them there.
struct Seen {
  bool hsync = false, vsync = false;
  VideoPixel of(const VideoPixel& in) {
    if (in.active) return {true, hsync, vsync, in.rgb};
    hsync = in.hsync;
    vsync = in.vsync;
    return {false, hsync, vsync, 0};
  }
};

bool same(const VideoPixel& a, const VideoPixel& b) {
  return a.active == b.active && a.hsync == b.hsync && a.vsync == b.vsync && a.rgb == b.rgb;
}

}  // namespace

TEST_CASE("460 words are colour and four are control", "[tmds]") {
  std::set<unsigned> values;
  int colours = 0;
  int controls = 0;
  for (unsigned word = 0; word < 1024; ++word) {
    const TmdsSymbol symbol = tmds_decode(word);
    if (symbol.control) ++controls;
    if (!symbol.control && symbol.valid) {
      ++colours;
      values.insert(symbol.value);
    }
  }
  REQUIRE(colours == 460);
  REQUIRE(controls == 4);
  REQUIRE(values.size() == 256);
}

TEST_CASE("each value at each disparity that can be reached", "[tmds]") {
  each_seed(1, [](Dice& dice) {
    Encoder encoder(dice);
    // A way to each disparity, found as it goes: values from blanking on.
    std::map<int, std::vector<unsigned>> ways{{0, {}}};
    std::vector<int> waiting{0};
    std::set<unsigned> words;
    while (!waiting.empty()) {
      const int before = waiting.back();
      waiting.pop_back();
      for (unsigned value = 0; value < 256; ++value) {
        const unsigned word = encoder.word_behind(ways[before], value);
        check_word(word, value, before);
        words.insert(word);
        const int after = before + disparity(word);
        if (ways.count(after) != 0) continue;
        ways[after] = ways[before];
        ways[after].push_back(value);
        waiting.push_back(after);
      }
    }
    REQUIRE(ways.size() == 9);  // -8, -6 .. 8
    REQUIRE(words.size() == 460);
  });
}

TEST_CASE("control and long runs of colour", "[tmds]") {
  each_seed(5, [](Dice& dice) {
    Encoder encoder(dice);
    struct Given {
      bool active;
      unsigned data, control;
    };
    std::deque<Given> inside;
    int sum = 0;
    for (int run = 0; run < 40; ++run) {
      const bool active = run % 2 == 1;
      const int length = active ? dice.between(1, 2000) : dice.between(1, 20);
      const int kind = dice.below(4);  // any value, one value, two in turn, dark
      const unsigned one = static_cast<unsigned>(dice.bits(8));
      const unsigned other = static_cast<unsigned>(dice.bits(8));
      for (int i = 0; i < length; ++i) {
        const unsigned any = static_cast<unsigned>(dice.bits(8));
        inside.push_back({active,
                          kind == 0   ? any
                          : kind == 1 ? one
                          : kind == 2 ? (i % 2 != 0 ? one : other)
                                      : any & 3,
                          static_cast<unsigned>(dice.bits(2))});
        const unsigned word = encoder.clock(active, inside.back().data, inside.back().control);
        if (inside.size() < 2) continue;
        const Given given = inside.front();
        inside.pop_front();
        if (given.active) {
          check_word(word, given.data, sum);
          sum += disparity(word);
        } else {
          const TmdsSymbol symbol = tmds_decode(word);
          REQUIRE(symbol.control);
          REQUIRE(symbol.value == given.control);
          REQUIRE(std::popcount((word ^ word >> 1) & 0x1FF) >= 7);
          sum = 0;
        }
      }
    }
  });
}

TEST_CASE("bit by bit through the shifter to a receiver", "[tmds]") {
  each_seed(12, [](Dice& dice) {
    const int skew = dice.between(-1, 1);
    INFO("skew " << skew);
    Link link(dice, skew);
    Seen seen;
    std::deque<VideoPixel> expected;
    std::size_t delay = 0;
    int compared = 0;
    const auto put = [&](const VideoPixel& in) {
      expected.push_back(seen.of(in));
      const auto out = link.pixel(in);
      INFO(link.receiver.fault());
      REQUIRE(link.receiver.fault().empty());
      if (!out) {
        REQUIRE(compared == 0);
        return;
      }
      if (delay == 0 && out->active) {  // the first pixel of colour tells how long the way is
        while (!expected.empty() && !expected.front().active) expected.pop_front();
        delay = expected.size();
        REQUIRE(delay >= 2);
        REQUIRE(delay <= 5);
      }
      if (delay == 0) return;
      REQUIRE(same(*out, expected.front()));
      expected.pop_front();
      ++compared;
    };
    for (int line = 0; line < 12; ++line) {
      for (int i = 0; i < 40; ++i) put({false, i > 10 && i < 20, line % 5 == 2, 0});
      const int length = dice.between(1, 200);
      for (int i = 0; i < length; ++i) put({true, false, false, static_cast<std::uint32_t>(dice.bits(24))});
    }
    REQUIRE(compared > 400);
    REQUIRE(link.receiver.worst_disparity() <= DviReceiver::kMaxDisparity);
    REQUIRE(link.receiver.worst_disparity() > 0);
  });
}

TEST_CASE("the receiver says no", "[tmds]") {
  // Words as an encoder sends them: blanking, then grey values that are balanced by themselves; one thing is wrong.
  const auto fault_after = [](auto change) {
    DviReceiver receiver;
    for (int i = 0; i < 60; ++i) {
      std::array<unsigned, 4> words{0x354, 0x354, 0x354, 0x01F};
      if (i >= 30) words = {0x1F0, 0x1F0, 0x1F0, 0x01F};
      change(i, words);
      for (int bit = 0; bit < 10; ++bit)
        receiver.put((words[0] >> bit & 1) != 0, (words[1] >> bit & 1) != 0, (words[2] >> bit & 1) != 0,
                     (words[3] >> bit & 1) != 0);
    }
    return receiver.fault().substr(0, receiver.fault().find(" (bit"));
  };
  using Words = std::array<unsigned, 4>;
  REQUIRE(fault_after([](int, Words&) {}).empty());
  REQUIRE(fault_after([](int i, Words& w) {
            if (i == 40) w[1] = 0x155;
          }) == "channel 1 sends a word that has no meaning, 341");
  REQUIRE(fault_after([](int i, Words& w) {
            if (i >= 40) w[2] = 0x1FF;
          }) == "channel 2 leans further to one side");
  REQUIRE(fault_after([](int i, Words& w) {
            if (i == 30) w[0] = 0x300;
          }) == "channel 0 has bits 8 and 9 alike without need");
  REQUIRE(fault_after([](int i, Words& w) {
            if (i == 40) w[0] = 0x354;
          }) == "the channels are not in blanking together");
  REQUIRE(fault_after([](int i, Words& w) {
            if (i == 25) w[2] = 0x0AB;
          }) == "channels 1 and 2 carry control bits");
  REQUIRE(fault_after([](int i, Words& w) {
            if (i == 40) w[3] = 0x00F;
          }) == "the clock is not five bits high and five low");
  REQUIRE(fault_after([](int i, Words& w) {
            if (i >= 40) w[3] = 0x03E;
          }) == "the clock has moved against the words");
}
