// SPDX-License-Identifier: Apache-2.0
// line_out: what comes out of lines that go in, under any back-pressure: background, RESOLVE's rounding, with counters
// and light table or without, TUSER and TLAST, no gap; and what goes back to the pixels.
#include <algorithm>
#include <array>
#include <deque>

#include "Vline_out1.h"
#include "Vline_out4.h"
#include "Vline_out_lights4.h"
#include "Vline_out_soft1.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

struct Shape {
  int lanes, max_width, shade_frac;
  bool translucent;
  int count_bits = 0, lights = 1, class_bits = 1;

  [[nodiscard]] kage::Config config() const {
    kage::Config c;
    c.x_bits = 5;
    c.shade_frac = shade_frac;
    c.translucency = translucent ? 1 : 0;
    c.count_bits = count_bits;
    c.lights = lights;
    c.class_bits = class_bits;
    return c;
  }
  [[nodiscard]] int pixel_bits() const {
    return count_bits == 0 ? 26 : 25 + (class_bits > 1 ? class_bits : 0) + lights * count_bits;
  }
};

struct Line {
  bool first, blank, load, painted;
  int width;
  std::uint32_t background, shade;
  std::vector<std::uint64_t> pixels;  // {dark, covered, colour} or {counts, class, covered, colour}
};

struct Out {
  std::uint32_t color;
  bool user, last;
};

using Table = std::vector<std::array<std::array<std::uint32_t, 3>, 8>>;  // share by class, light, channel

/// What a pixel keeps of a channel, in 2^-shade_frac.
std::uint32_t factor(const Shape& s, std::uint64_t pixel, const Table& table, std::uint32_t shade,
                     std::size_t channel) {
  const std::int64_t one = std::int64_t{1} << s.shade_frac;
  std::int64_t kept = one;
  if (s.count_bits == 0) {
    if ((pixel >> 25 & 1) != 0) kept -= shade;
    return static_cast<std::uint32_t>(kept);
  }
  pixel >>= 25;
  const std::size_t normal_class = s.class_bits > 1 ? pixel & ((1U << s.class_bits) - 1) : 1;
  if (s.class_bits > 1) pixel >>= s.class_bits;
  for (std::size_t light = 0; light < static_cast<std::size_t>(s.lights); ++light, pixel >>= s.count_bits) {
    const std::int64_t share = s.class_bits > 1 ? table[normal_class][light][channel] : shade;
    kept -= share * static_cast<std::int64_t>(pixel & ((1U << s.count_bits) - 1));
  }
  return static_cast<std::uint32_t>(std::max<std::int64_t>(kept, 0));
}

/// Write a whole table, an entry a clock.
template <class Model>
void load_table(Bench<Model>& top, Dice& dice, const Shape& s, Table& table) {
  const TableEntryBus entry(s.config());
  table.resize(std::size_t{1} << s.class_bits);
  top->line_valid_i = top->exit_take_i = top->exit_valid_i = 0;
  top->table_valid_i = 1;
  for (std::size_t k = 1; k < table.size(); ++k)
    for (std::size_t light = 0; light < static_cast<std::size_t>(s.lights); ++light) {
      put(top->table_i, entry.normal_class, k);
      put(top->table_i, entry.light, light);
      for (std::size_t c = 0; c < 3; ++c) {
        table[k][light][c] = dice.percent(20) ? 1U << s.shade_frac
                                              : static_cast<std::uint32_t>(dice.bits(s.shade_frac)) >> dice.below(4);
        put(top->table_i, entry.share.lsb + static_cast<int>(c) * (s.shade_frac + 1), s.shade_frac + 1,
            table[k][light][c]);
      }
      top.edge();
    }
  top->table_valid_i = 0;
}

template <class Model>
void line_test(const Shape& s) {
  each_seed(15, [&](Dice& dice) {
    Bench<Model> top(dice);
    const LineBus line(s.config());
    const LoadBus load(s.config());
    const int in_stall = stall_percent(dice);
    const int out_stall = stall_percent(dice);
    std::deque<Line> announced, to_fill;
    std::deque<Out> expected, loads;
    std::deque<std::size_t> load_places;
    Table table;
    const bool has_loads = s.translucent && s.count_bits > 0;
    std::uint32_t background = 0, shade = 0;
    int made = 0, width = 1, left = 0, taken_lines = 0, filled = 0;
    bool waited = false;
    Out before{};
    for (int clock = 0; made < 14 || !expected.empty() || !loads.empty(); ++clock) {
      REQUIRE(clock < 100000);
      // A new table waits for all lines of the frame before.
      const bool empty = announced.empty() && to_fill.empty() && expected.empty() && loads.empty();
      if (s.class_bits > 1 && left == 0 && made < 14 && empty) load_table(top, dice, s, table);
      if (made < 14 && announced.size() < 3 && (s.class_bits == 1 || left > 0 || empty)) {
        Line l{};
        l.first = left == 0;
        if (l.first) {
          width = dice.percent(30) ? s.max_width : dice.between(1, s.max_width);
          left = dice.between(1, 4);
          background = static_cast<std::uint32_t>(dice.bits(24));
          shade = dice.percent(30) ? 1U << s.shade_frac : static_cast<std::uint32_t>(dice.bits(s.shade_frac));
        }
        --left;
        l.blank = dice.percent(20);
        l.load = has_loads && dice.percent(30);
        l.painted = !l.load && dice.percent(30);
        l.width = width;
        l.background = background;
        l.shade = shade;
        for (int x = 0; x < width; ++x) {
          std::uint64_t p = dice.bits(s.pixel_bits());
          const int class_at = 25;  // counts are 0 where the class is
          if (s.class_bits > 1 && (p >> class_at & ((1U << s.class_bits) - 1)) == 0) p &= (1U << class_at) - 1;
          l.pixels.push_back(p);
          std::uint32_t color = 0;
          for (std::size_t c = 0; c < 3; ++c)
            color |=
                static_cast<std::uint32_t>(
                    ((p >> 8 * c & 255) * factor(s, p, table, shade, c) + (1U << (s.shade_frac - 1))) >> s.shade_frac)
                << 8 * c;
          if (l.blank || ((p >> 24 & 1) == 0 && !(s.translucent && l.painted))) color = background;
          if (l.load) load_places.push_back(static_cast<std::size_t>(x));
          (l.load ? loads : expected).push_back({color, l.first && x == 0, x == width - 1});
        }
        announced.push_back(l);
        to_fill.push_back(l);
        ++made;
      }
      top->line_valid_i = announced.empty() ? 0 : 1;
      if (!announced.empty()) {
        const Line& l = announced.front();
        put(top->line_i, line.first, l.first ? 1 : 0);
        put(top->line_i, line.blank, l.blank ? 1 : 0);
        put(top->line_i, line.painted, l.painted ? 1 : 0);
        put(top->line_i, line.load, l.load ? 1 : 0);
        put(top->line_i, line.width, static_cast<std::uint64_t>(l.width));
        put(top->line_i, line.background, l.background);
        put(top->line_i, line.shade, l.shade);
      }
      top->exit_take_i = 0;
      top->exit_valid_i = 0;
      top.settle();
      // One line at a time takes a buffer and then comes in, group by group, as from the pixels.
      if (taken_lines == 0 && !to_fill.empty() && top->exit_free_o && !dice.percent(in_stall)) {
        top->exit_take_i = 1;
      }
      if (taken_lines == 1) {
        const Line& l = to_fill.front();
        top->exit_valid_i = 1;
        for (int lane = 0; lane < s.lanes; ++lane) {
          const int x = filled + lane;
          put(top->exit_data_i, s.pixel_bits() * lane, s.pixel_bits(),
              x < l.width ? l.pixels[static_cast<std::size_t>(x)] : dice.bits(s.pixel_bits()));
        }
        top->exit_last_i = filled + s.lanes >= l.width ? 1 : 0;
      }
      top->m_ready_i = dice.percent(out_stall) ? 0 : 1;
      top->load_ready_i = dice.percent(out_stall) ? 0 : 1;
      top.settle();
      if (waited) {
        REQUIRE(top->m_valid_o);
        REQUIRE((top->m_data_o == before.color && top->m_user_o == before.user && top->m_last_o == before.last));
      }
      waited = top->m_valid_o && !top->m_ready_i;
      before = {top->m_data_o, static_cast<bool>(top->m_user_o), static_cast<bool>(top->m_last_o)};
      if (top->m_valid_o && top->m_ready_i) {
        REQUIRE(!expected.empty());
        REQUIRE(top->m_data_o == expected.front().color);
        REQUIRE(static_cast<bool>(top->m_user_o) == expected.front().user);
        REQUIRE(static_cast<bool>(top->m_last_o) == expected.front().last);
        expected.pop_front();
      }
      if (top->load_valid_o) REQUIRE(!loads.empty());
      if (top->load_valid_o && top->load_ready_i) {
        REQUIRE(get(top->load_o, load.color) == loads.front().color);
        REQUIRE(get(top->load_o, load.x) == load_places.front());
        REQUIRE((get(top->load_o, load.last) != 0) == loads.front().last);
        loads.pop_front();
        load_places.pop_front();
      }
      const bool line_taken = top->line_valid_i && top->line_ready_o;
      const bool take = top->exit_take_i;
      const bool fill = top->exit_valid_i;
      const bool complete = fill && top->exit_last_i;
      top.edge();
      if (line_taken) announced.pop_front();
      if (take) {
        taken_lines = 1;
        filled = 0;
      } else if (complete) {
        taken_lines = 0;
        to_fill.pop_front();
      } else if (fill) {
        filled += s.lanes;
      }
    }
  });
}

}  // namespace

TEST_CASE("line_out, groups of four", "[line_out]") { line_test<Vline_out4>({4, 21, 8, true}); }
TEST_CASE("line_out, single pixels", "[line_out]") { line_test<Vline_out1>({1, 21, 3, false}); }

TEST_CASE("line_out, one counter, no table", "[line_out]") { line_test<Vline_out_soft1>({1, 21, 8, false, 4}); }
TEST_CASE("line_out, counters of three lights, table, loads", "[line_out]") {
  line_test<Vline_out_lights4>({4, 21, 6, true, 3, 3, 4});
}

TEST_CASE("line_out sends the lines of a frame without a gap", "[line_out]") {
  each_seed(2, [](Dice& dice) {
    Bench<Vline_out4> top(dice);
    const LineBus line(Shape{4, 21, 8, true}.config());
    const int width = 16, lines = 10;
    int announced = 0, groups = 0, taken = 0, pixels = 0, first = 0, last = 0;
    top->m_ready_i = 1;
    for (int clock = 0; pixels < width * lines; ++clock) {
      top->line_valid_i = announced < lines ? 1 : 0;
      put(top->line_i, line.first, announced == 0 ? 1 : 0);
      put(top->line_i, line.blank, 0);
      put(top->line_i, line.width, width);
      top->exit_take_i = 0;
      top->exit_valid_i = 0;
      top.settle();
      if (groups == taken * (width / 4) && taken < lines && top->exit_free_o) {
        top->exit_take_i = 1;
        ++taken;
      } else if (groups < taken * (width / 4)) {
        top->exit_valid_i = 1;
        top->exit_last_i = groups % (width / 4) == width / 4 - 1 ? 1 : 0;
        ++groups;
      }
      top.settle();
      if (top->line_ready_o) ++announced;
      if (top->m_valid_o) {
        if (pixels == 0) first = clock;
        last = clock;
        ++pixels;
      }
      top.edge();
      REQUIRE(clock < 10000);
    }
    REQUIRE(last - first == width * lines - 1);
  });
}
