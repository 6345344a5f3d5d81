// SPDX-License-Identifier: Apache-2.0
// line_capture: of all lines the chosen one is kept, pixel by pixel, and counted.
#include <array>
#include <deque>
#include <optional>

#include "Vcapture1.h"
#include "Vcapture3.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

template <class Model>
void captures() {
  constexpr int kChannels = parameter<Model>("CHANNELS");
  constexpr std::size_t kPixels = parameter<Model>("PIXELS");
  each_seed(100, [](Dice& dice) {
    Bench<Model> top(dice);
    top->beat_i = 0;
    top->clear_i = 0;
    std::array<std::optional<std::uint32_t>, kPixels> ram{};
    int compared = 0;
    std::uint64_t count = 0;             // of the chosen line's pixels that have to show
    std::optional<std::uint32_t> moved;  // in the clock before, of the chosen line
    for (int round = 0; round < 6; ++round) {
      const int lines = dice.between(1, 12);
      const bool final = round == 5;
      const int chosen = final ? 0 : dice.below(lines + 1);  // the last of these never comes
      const int most = dice.percent(40) ? 1 : dice.percent(50) ? 8 : static_cast<int>(2 * kPixels);
      const int stall = stall_percent(dice);
      int number = 0;  // of the line at hand
      // One clock; `pixel` moves if it is there.
      const auto clock = [&](const std::uint32_t* pixel, bool clear) {
        const std::uint32_t shown = pixel != nullptr ? *pixel : static_cast<std::uint32_t>(dice.bits(32));
        top->beat_i = pixel != nullptr ? 1 : 0;
        top->clear_i = clear ? 1 : 0;
        put(top->data_i, shown & ((1U << (8 * kChannels)) - 1));
        top->last_i = shown >> 24 & 1;
        top->user_i = shown >> 25 & 1;
        put(top->host_addr_i, static_cast<std::uint64_t>(dice.below(kPixels)));
        const auto host = static_cast<std::size_t>(top->host_addr_i);
        const std::optional<std::uint32_t> read = ram[host];
        bool defined = read.has_value();
        top.edge();
        if (moved && count < kPixels) {
          if (host == count) defined = false;
          ram[count] = clear ? std::nullopt : moved;  // clear_i may be too late for it or not
        }
        if (moved) ++count;
        moved.reset();
        if (clear) {
          number = 0;
          count = 0;
        } else if (pixel != nullptr) {
          if (number == chosen) moved = *pixel;
          if ((*pixel >> 24 & 1) != 0) ++number;
        }
        REQUIRE(top->pixels_o == count);
        if (defined) {
          REQUIRE(top->host_rd_data_o == *read);
          ++compared;
        }
      };
      const auto any = [&](bool last) {
        return static_cast<std::uint32_t>(dice.bits(8 * kChannels)) | (last ? 1U : 0U) << 24 |
               static_cast<std::uint32_t>(dice.bits(1)) << 25;
      };
      const std::uint32_t lost = any(dice.percent(50));
      top->line_i = static_cast<SData>(chosen);
      clock(dice.percent(50) ? &lost : nullptr, true);  // a pixel in the clock of clear_i belongs to nothing
      for (int line = 0; line < lines; ++line) {
        const int pixels = dice.between(1, most);
        for (int x = 0; x < pixels; ++x) {
          while (dice.percent(stall)) clock(nullptr, false);
          const std::uint32_t pixel = any(x + 1 == pixels);
          clock(&pixel, false);
        }
      }
      for (int rest = final ? 100 : dice.below(30); rest > 0; --rest) clock(nullptr, false);
    }
    REQUIRE(compared > 0);
  });
}

}  // namespace

TEST_CASE("line_capture keeps one line of one channel", "[line_capture]") { captures<Vcapture1>(); }
TEST_CASE("line_capture keeps one line of three channels", "[line_capture]") { captures<Vcapture3>(); }
TEST_CASE("line_capture counts at most 65535 pixels, and lines modulo 65536", "[line_capture]") {
  Dice dice(new_seed());
  Bench<Vcapture3> top(dice);
  const auto start = [&](int line) {
    top->line_i = static_cast<SData>(line);
    top->clear_i = 1;
    top.edge();
    top->clear_i = 0;
  };
  top->beat_i = 1;
  top->last_i = 0;
  start(0);
  for (int i = 0; i < 65600; ++i) top.edge();
  REQUIRE(top->pixels_o == 65535);
  start(65535);
  top->last_i = 1;
  for (int i = 0; i < 65536; ++i) top.edge();
  top->beat_i = 0;
  REQUIRE(top->pixels_o == 0);
  top.edge();
  REQUIRE(top->pixels_o == 1);
}
