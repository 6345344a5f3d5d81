// SPDX-License-Identifier: Apache-2.0
// display_curve: every level of three widths is displayed as the sRGB formula says, after LightStages moves, whatever
// the clocks in which it rests; displayed pixels pass as they are.
#include <cmath>
#include <deque>

#include "Vcurve10.h"
#include "Vcurve12.h"
#include "Vcurve14.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

constexpr int kStages = 8;

unsigned formula(std::uint64_t level, int bits) {
  const long double x = std::ldexp(static_cast<long double>(level), -bits);
  const long double s = x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
  return static_cast<unsigned>(std::lround(255 * s));
}

template <class Model>
void curve_test(int bits) {
  each_seed(1, [&](Dice& dice) {
    Bench<Model> top(dice);
    std::deque<std::uint64_t> inside;  // what must leave, the oldest first
    const std::uint64_t levels = std::uint64_t{1} << bits;
    int checked = 0;
    for (std::uint64_t next = 0; next < levels + kStages;) {
      const std::uint64_t level = next % levels;
      const std::uint64_t other = dice.bits(bits);
      const bool covered = dice.percent(50);
      const bool shown = dice.percent(20);
      top->go_i = dice.percent(80) ? 1 : 0;
      put(top->pixel_i, 0, bits, level);
      put(top->pixel_i, bits, bits, other);
      put(top->pixel_i, 2 * bits, bits, levels - 1 - level);
      put(top->pixel_i, 3 * bits, 1, covered ? 1 : 0);
      top->shown_i = shown ? 1 : 0;
      top.settle();
      const auto displayed = [&](std::uint64_t v) { return shown ? v & 255U : formula(v, bits); };
      const bool goes = top->go_i != 0;
      top.edge();
      if (!goes) continue;
      ++next;
      inside.push_back(displayed(level) | displayed(other) << 8 | displayed(levels - 1 - level) << 16 |
                       std::uint64_t{covered} << 24);
      if (inside.size() < kStages) continue;
      top.settle();
      REQUIRE(top->pixel_o == inside.front());
      inside.pop_front();
      ++checked;
    }
    REQUIRE(checked > static_cast<int>(levels));
  });
}

}  // namespace

TEST_CASE("display_curve shows each level as the formula says", "[display_curve]") {
  curve_test<Vcurve10>(10);
  curve_test<Vcurve12>(12);
  curve_test<Vcurve14>(14);
}
