// SPDX-License-Identifier: Apache-2.0
// line_signature against zlib's CRC-32: what is kept, what is compared, at which clock, and which line has which place.
#include <zlib.h>

#include <array>
#include <optional>

#include "Vsignature1.h"
#include "Vsignature3.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

struct Pixel {
  std::uint32_t data;
  bool user, last;
};

/// The module and what it must say, clock by clock. A line's place is never cut to a number of bits here.
template <class Model>
class Signed {
 public:
  static constexpr int kChannels = parameter<Model>("CHANNELS");
  static constexpr std::size_t kLines = parameter<Model>("LINES");

  explicit Signed(Dice& dice) : top(dice), dice_(dice) {
    top->beat_i = 0;
    top->clear_i = 0;
    top->check_i = 0;
    top->wrap_i = 0;
    top->host_wr_en_i = 0;
    clear();
  }

  static std::uint32_t signature(const std::vector<Pixel>& line) {
    uLong crc = crc32(0, nullptr, 0);
    for (const Pixel& pixel : line) {
      std::array<Bytef, 4> bytes{};
      for (std::size_t c = 0; c < kChannels; ++c) bytes[c] = static_cast<Bytef>(pixel.data >> (8 * c));
      bytes[kChannels] = static_cast<Bytef>(2 * pixel.user + pixel.last);
      crc = crc32(crc, bytes.data(), kChannels + 1);
    }
    return static_cast<std::uint32_t>(crc);
  }

  Pixel pixel(bool last) const {
    return {static_cast<std::uint32_t>(dice_.bits(8 * kChannels)), dice_.percent(30), last};
  }

  void idle(int clocks) {
    for (int i = 0; i < clocks; ++i) clock(nullptr);
  }
  void draw(const std::vector<Pixel>& line, int stall) {
    for (const Pixel& pixel : line) {
      while (dice_.percent(stall)) clock(nullptr);
      clock(&pixel);
    }
  }
  void clear() {
    top->clear_i = 1;
    const Pixel lost = pixel(dice_.percent(50));
    clock(dice_.percent(50) ? &lost : nullptr);  // a pixel in the clock of clear_i belongs to nothing
    top->clear_i = 0;
  }
  void host_write(std::size_t place, std::uint32_t value) {
    top->host_wr_en_i = 1;
    top->host_wr_data_i = value;
    address_ = place;
    clock(nullptr);
    top->host_wr_en_i = 0;
    address_.reset();
  }
  /// Reads all words that are known, one a clock.
  int host_check() {
    int known = 0;
    for (std::size_t place = 0; place < kLines; ++place) {
      address_ = place;
      clock(nullptr);
      if (ram[place]) {
        REQUIRE(top->host_rd_data_o == *ram[place]);
        ++known;
      }
    }
    address_.reset();
    return known;
  }

  Bench<Model> top;
  std::array<std::optional<std::uint32_t>, kLines> ram{};
  std::uint64_t lines = 0, mismatches = 0, mismatch_place = 0;

 private:
  struct Ended {
    std::uint64_t at, place;
    std::uint32_t value;
    bool differs;
  };

  void clock(const Pixel* pixel) {
    top->beat_i = pixel != nullptr ? 1 : 0;
    const Pixel shown = pixel != nullptr ? *pixel : this->pixel(dice_.percent(50));
    put(top->data_i, shown.data);
    top->user_i = shown.user ? 1 : 0;
    top->last_i = shown.last ? 1 : 0;
    put(top->host_addr_i, address_ ? *address_ : static_cast<std::size_t>(dice_.below(kLines)));
    const auto host = static_cast<std::size_t>(top->host_addr_i);
    const std::optional<std::uint32_t> read = ram[host];
    bool mine = top->host_wr_en_i == 0;  // the host reads, and no line has the port
    top.edge();
    const std::uint64_t now = top.clocks;
    if (top->host_wr_en_i) ram[host] = top->host_wr_data_i;
    for (Ended& line : ended_) {
      if (line.at + 2 == now && top->check_i) mine = false;
      if (line.at + 2 == now && line.place < kLines) {
        if (top->check_i) {
          line.differs = ram[line.place] != line.value;
        } else {
          mine = mine && host != line.place;
          ram[line.place] = line.value;
        }
      }
      if (line.at + 3 == now) ++lines;
      if (line.at + 4 == now && line.differs && ++mismatches == 1) mismatch_place = line.place;
    }
    while (!ended_.empty() && ended_.front().at + 4 <= now) ended_.erase(ended_.begin());
    if (top->clear_i) {
      // Lines that had ended and were not kept may be or not.
      for (const Ended& line : ended_)
        if (line.at + 2 >= now && line.place < kLines && !top->check_i) ram[line.place].reset();
      ended_.clear();
      line_.clear();
      next_place_ = lines = mismatches = 0;
    } else if (pixel != nullptr) {
      line_.push_back(*pixel);
      if (pixel->last) {
        ended_.push_back({now, next_place_, signature(line_), false});
        line_.clear();
        if (++next_place_ == top->wrap_i) next_place_ = 0;
      }
    }
    REQUIRE(top->lines_o == lines % 65536);
    REQUIRE(top->mismatches_o == std::min<std::uint64_t>(mismatches, 65535));
    if (mismatches > 0) REQUIRE(top->mismatch_place_o == mismatch_place);
    if (mine && read) REQUIRE(top->host_rd_data_o == *read);
  }

  Dice& dice_;
  std::vector<Pixel> line_;
  std::vector<Ended> ended_;
  std::uint64_t next_place_ = 0;
  std::optional<std::size_t> address_;
};

template <class Model>
void keeps_and_compares() {
  each_seed(100, [](Dice& dice) {
    Signed<Model> top(dice);
    constexpr int kLines = static_cast<int>(Signed<Model>::kLines);
    int compared = 0;
    for (int round = 0; round < 4; ++round) {
      top.top->wrap_i = static_cast<SData>(dice.percent(50) ? 0 : dice.between(1, kLines + 5));
      const int stall = stall_percent(dice);
      const int most = dice.percent(50) ? 1 : 12;  // of one pixel, back to back
      std::vector<std::vector<Pixel>> lines(static_cast<std::size_t>(dice.between(1, 2 * kLines)));
      for (auto& line : lines) {
        line.resize(static_cast<std::size_t>(dice.between(1, most)));
        for (Pixel& pixel : line) pixel = top.pixel(&pixel == &line.back());
      }
      top.top->check_i = 0;
      for (const auto& line : lines) top.draw(line, stall);
      if (dice.percent(30)) top.draw({top.pixel(false), top.pixel(false)}, stall);  // clear_i comes in the middle of it
      if (dice.percent(50)) {
        top.idle(4);
        REQUIRE(top.host_check() > 0);
      }
      top.clear();
      // The second pass must find what the first pass left, but for what the host changes.
      for (std::size_t place = 0; place < top.ram.size(); ++place) {
        const auto value = static_cast<std::uint32_t>(dice.bits(32));
        const auto bit = std::uint32_t{1} << dice.below(32);
        if (!top.ram[place])
          top.host_write(place, value);
        else if (dice.percent(10) || (round == 3 && place == 0))
          top.host_write(place, *top.ram[place] ^ bit);
      }
      top.top->check_i = 1;
      for (const auto& line : lines) top.draw(line, stall);
      top.idle(5);
      compared += static_cast<int>(top.mismatches);
      top.top->check_i = 0;
      REQUIRE(top.host_check() == kLines);
      top.clear();
    }
    REQUIRE(compared > 0);
  });
}

/// Numbers of 16 bits end, and what is behind LINES stays out of the RAM.
template <class Model>
void many_lines(bool wrap, bool check) {
  Dice dice(new_seed());
  Signed<Model> top(dice);
  for (std::size_t place = 0; place < top.ram.size(); ++place) top.host_write(place, 1);
  top.top->wrap_i = wrap ? 1 : 0;
  top.top->check_i = check ? 1 : 0;
  const std::vector<Pixel> line{top.pixel(true)};
  for (int i = 0; i < 65536 + 100; ++i) top.draw(line, 0);
  top.idle(5);
  REQUIRE(top.lines == 65536 + 100);
  REQUIRE(top.mismatches == (!check ? 0 : wrap ? 65536 + 100 : Signed<Model>::kLines));
  top.top->check_i = 0;
  REQUIRE(top.host_check() > 0);
}

}  // namespace

TEST_CASE("line_signature keeps and compares signatures of one channel", "[line_signature]") {
  keeps_and_compares<Vsignature1>();
}
TEST_CASE("line_signature keeps and compares signatures of three channels", "[line_signature]") {
  keeps_and_compares<Vsignature3>();
}
TEST_CASE("line_signature counts more lines than 16 bits hold", "[line_signature]") {
  many_lines<Vsignature3>(false, false);
  many_lines<Vsignature3>(false, true);
  many_lines<Vsignature1>(true, true);
}
