// SPDX-License-Identifier: Apache-2.0
// uart_receiver and uart_transmitter against a line in real time: what is on it at a moment is a matter of edges at
// fractions of a clock, which the standard's 8N1 gives. Also kage_crc.svh against zlib and Boost.
#include <zlib.h>

#include <boost/crc.hpp>
#include <cmath>
#include <deque>
#include <string>
#include <vector>

#include "Vcrc_bytes.h"
#include "Vuart_receiver12.h"
#include "Vuart_receiver25.h"
#include "Vuart_receiver48.h"
#include "Vuart_receiver50.h"
#include "Vuart_transmitter12.h"
#include "Vuart_transmitter25.h"
#include "Vuart_transmitter48.h"
#include "Vuart_transmitter50.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

/// A line's level over time, in clocks: high at first, and turned at each edge.
class Line {
 public:
  /// Holds a level from where the line's past ends.
  void hold(bool level, double clocks) {
    if (level != last_) edges_.push_back(end_);
    last_ = level;
    end_ += clocks;
  }
  /// A byte as 8N1 has it, with bits of `bit` clocks; `stop`: the level of the stop bit.
  void byte(std::uint8_t value, double bit, bool stop = true) {
    hold(false, bit);
    for (int i = 0; i < 8; ++i) hold((value >> i & 1) != 0, bit);
    hold(stop, bit);
  }
  /// The level at a time; times rise.
  bool at(double time) {
    while (!edges_.empty() && edges_.front() <= time) {
      edges_.pop_front();
      level_ = !level_;
    }
    return level_;
  }
  [[nodiscard]] double end() const { return end_; }

 private:
  std::deque<double> edges_;
  bool level_ = true, last_ = true;
  double end_ = 0;
};

template <class Model>
double clocks_a_bit() {
  return static_cast<double>(parameter<Model>("CLOCK_HZ")) / parameter<Model>("BAUD");
}

/// How far the sender's rate may be off, as uart_receiver.sv derives it, less the accumulator's rounding. The stop bit
/// is read at 9.5 bits, give or take a clock, and ends 10 of the sender's bits after the start bit's edge.
double tolerance(double bit) { return (0.5 - 1 / bit) / 10 - 0.0003; }

struct Heard {
  std::vector<std::uint8_t> bytes;
  int framing_errors = 0;
};

template <class Model>
Heard hear(Dice& dice, Line& line) {
  Bench<Model> top(dice);
  Heard heard;
  top->rx_i = 1;
  for (int i = 0; i < 8; ++i) top.edge();
  for (double time = 0; time < line.end() + 100; time += 1) {
    top->rx_i = line.at(time) ? 1 : 0;
    top.settle();
    if (top->valid_o) heard.bytes.push_back(top->data_o);
    if (top->framing_error_o) ++heard.framing_errors;
    REQUIRE(!(top->valid_o && top->framing_error_o));
    top.edge();
  }
  return heard;
}

double fraction(Dice& dice) { return static_cast<double>(dice.bits(32)) / 4294967296.0; }

std::vector<std::uint8_t> shuffled_bytes(Dice& dice) {
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 256; ++i) bytes.push_back(static_cast<std::uint8_t>(i));
  for (std::size_t i = 255; i > 0; --i)
    std::swap(bytes[i], bytes[static_cast<std::size_t>(dice.below(static_cast<int>(i) + 1))]);
  return bytes;
}

/// All bytes without a pause, from a sender that is off by a share of a bit.
template <class Model>
std::vector<std::uint8_t> heard_back_to_back(Dice& dice, const std::vector<std::uint8_t>& bytes, double off) {
  Line line;
  const double bit = clocks_a_bit<Model>() * (1 + off);
  line.hold(true, 20 + fraction(dice));
  for (const std::uint8_t byte : bytes) line.byte(byte, bit);
  line.hold(true, 20 * bit);
  return hear<Model>(dice, line).bytes;
}

template <class Model>
void receives() {
  const double most = tolerance(clocks_a_bit<Model>());
  REQUIRE(most > 0.02);
  each_seed(6, [&](Dice& dice) {
    const std::vector<std::uint8_t> bytes = shuffled_bytes(dice);
    for (const double off : {0.0, 0.02, -0.02, most * 0.99, -most * 0.99}) {
      INFO("off by " << off);
      REQUIRE(heard_back_to_back<Model>(dice, bytes, off) == bytes);
    }
    // A sender is not understood, whatever the phase, if it is off by so much that the stop bit is read beside its
    // edge.
    const double too_much = 0.07;
    REQUIRE(heard_back_to_back<Model>(dice, bytes, -too_much) != bytes);
    // Pauses of any length.
    Line line;
    const double bit = clocks_a_bit<Model>() * (1 + (fraction(dice) - 0.5) * 0.04);
    for (const std::uint8_t byte : bytes) {
      line.hold(true, dice.percent(50) ? 0.0 : fraction(dice) * 3 * bit);
      line.byte(byte, bit);
    }
    line.hold(true, 20 * bit);
    REQUIRE(hear<Model>(dice, line).bytes == bytes);
  });
}

template <class Model>
void ignores() {
  each_seed(20, [](Dice& dice) {
    const double bit = clocks_a_bit<Model>() * (1 + (fraction(dice) - 0.5) * 0.04);
    const double half = clocks_a_bit<Model>() / 2;
    Line line;
    std::vector<std::uint8_t> bytes;
    int broken = 0;
    line.hold(true, 3 * bit);
    for (int i = 0; i < 60; ++i) {
      const auto byte = static_cast<std::uint8_t>(dice.bits(8));
      switch (dice.below(5)) {
        case 0:  // glitches shorter than half a bit; between them the line is high for three clocks, so that it is seen
          for (int n = dice.between(1, 5); n > 0; --n) {
            line.hold(false, fraction(dice) * half);
            line.hold(true, 3 + fraction(dice) * bit);
          }
          break;
        case 1:  // a break
          line.hold(false, (11 + fraction(dice) * 40) * bit);
          line.hold(true, 3 + fraction(dice) * bit);
          ++broken;
          break;
        case 2:  // a stop bit that is low, and low on for any time
          line.byte(byte, bit, false);
          if (dice.percent(50)) line.hold(false, fraction(dice) * 3 * bit);
          line.hold(true, 3 + fraction(dice) * bit);
          ++broken;
          break;
        default:
          line.byte(byte, bit);
          bytes.push_back(byte);
          if (dice.percent(50)) line.hold(true, fraction(dice) * bit);
      }
    }
    line.hold(true, 20 * bit);
    const Heard heard = hear<Model>(dice, line);
    REQUIRE(heard.bytes == bytes);
    REQUIRE(heard.framing_errors == broken);
  });
}

template <class Model>
void transmits() {
  const double bit = clocks_a_bit<Model>();
  // The rounding of the accumulator is at most 1/4096 of what has passed: 10 / 4096 bits at a byte's end. Four clocks a
  // bit are a fraction that it has.
  const double slack = bit == 4 ? 0 : 10 * bit / 4096;
  each_seed(4, [&](Dice& dice) {
    Bench<Model> top(dice);
    const std::vector<std::uint8_t> bytes = shuffled_bytes(dice);
    Offer offer(stall_percent(dice));
    const bool gaps = dice.percent(50);
    std::size_t next = 0;
    std::vector<bool> levels;
    while (next < bytes.size() || !top->ready_o || levels.size() < 100) {
      const bool on = gaps ? offer(dice, next < bytes.size()) : next < bytes.size();
      top->valid_i = on ? 1 : 0;
      top->data_i = on ? bytes[next] : static_cast<std::uint8_t>(dice.bits(8));
      top.settle();
      levels.push_back(top->tx_o != 0);
      if (top->valid_i && top->ready_o) {
        ++next;
        offer.taken();
      }
      top.edge();
      REQUIRE(levels.size() < 10'000'000);
    }
    // Every edge of a byte is where 8N1 has it, or less than a clock late.
    std::size_t at = 0;
    const auto level = [&](std::size_t clock) { return clock >= levels.size() || levels[clock]; };
    std::size_t before = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      while (level(at)) REQUIRE(++at < levels.size());
      if (!gaps && i > 0) REQUIRE(static_cast<double>(at - before) < 10 * bit + 1 + slack);  // back to back
      if (i > 0) REQUIRE(static_cast<double>(at - before) >= 10 * bit - slack);
      before = at;
      for (int n = 0; n < 10; ++n) {
        const bool want = n == 9 || (n > 0 && (bytes[i] >> (n - 1) & 1) != 0);
        const auto from = static_cast<std::size_t>(std::ceil(n * bit + (n > 0 ? slack : 0)));
        const auto to = static_cast<std::size_t>(std::floor((n + 1) * bit - slack));
        for (std::size_t clock = from; clock < to; ++clock) {
          INFO("byte " << i << " bit " << n << " clock " << clock);
          REQUIRE(level(at + clock) == want);
        }
      }
      at += static_cast<std::size_t>(9 * bit + 1);
    }
  });
}

}  // namespace

TEST_CASE("uart_receiver hears all bytes back to back, of a sender that is off by what its contract says", "[uart]") {
  receives<Vuart_receiver12>();
  receives<Vuart_receiver25>();
  receives<Vuart_receiver48>();
  receives<Vuart_receiver50>();
}

TEST_CASE("uart_receiver ignores glitches and breaks, and drops bytes without a stop bit", "[uart]") {
  ignores<Vuart_receiver12>();
  ignores<Vuart_receiver25>();
  ignores<Vuart_receiver48>();
  ignores<Vuart_receiver50>();
}

TEST_CASE("uart_receiver waits for a high line after reset", "[uart]") {
  each_seed(5, [](Dice& dice) {
    Bench<Vuart_receiver25> top(dice);
    int heard = 0;
    const int low = dice.between(1, 400);
    for (int i = 0; i < low + 400; ++i) {
      top->rx_i = i < low ? 0 : 1;
      top.edge();
      heard += top->valid_o + top->framing_error_o;
    }
    REQUIRE(heard == 0);
  });
}

TEST_CASE("uart_transmitter's edges are where 8N1 has them", "[uart]") {
  transmits<Vuart_transmitter12>();
  transmits<Vuart_transmitter25>();
  transmits<Vuart_transmitter48>();
  transmits<Vuart_transmitter50>();
}

TEST_CASE("the checks of kage_crc.svh are Boost's CRC-16/X-25 and zlib's CRC-32", "[uart]") {
  each_seed(20, [](Dice& dice) {
    Bench<Vcrc_bytes> top(dice);
    const auto give = [&](std::uint8_t byte) {
      top->start_i = 0;
      top->valid_i = 1;
      top->data_i = byte;
      top.edge();
      top->valid_i = 0;
    };
    top->start_i = 1;
    top.edge();
    std::vector<std::uint8_t> bytes;
    if (dice.percent(20)) {
      for (const char c : std::string("123456789")) bytes.push_back(static_cast<std::uint8_t>(c));
    } else {
      for (int n = dice.between(0, 300); n > 0; --n) bytes.push_back(static_cast<std::uint8_t>(dice.bits(8)));
    }
    for (const std::uint8_t byte : bytes) {
      give(byte);
      if (dice.percent(10)) top.edge();
    }
    boost::crc_optimal<16, 0x1021, 0xFFFF, 0xFFFF, true, true> crc;
    crc.process_bytes(bytes.data(), bytes.size());
    REQUIRE(top->crc16_o == crc.checksum());
    REQUIRE(top->crc32_o == crc32_z(0, bytes.data(), bytes.size()));
    const unsigned sum = top->crc16_o;
    give(static_cast<std::uint8_t>(sum & 0xFF));
    give(static_cast<std::uint8_t>(sum >> 8));
    REQUIRE(top->good_o);
  });
}
