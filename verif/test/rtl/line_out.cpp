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

struct Shape : kage::Config {
  [[nodiscard]] constexpr int pixel_bits() const { return kage::derived::exit_bits(*this); }
  [[nodiscard]] constexpr bool has_table() const { return kage::derived::has_table(*this); }
  [[nodiscard]] constexpr bool has_loads() const { return kage::derived::has_loads(*this); }
};

/// The values that the lines of a frame have in common.
struct Frame {
  int width = 1;
  std::uint32_t background = 0, shade = 0;
};

struct Line {
  bool first, blank, load, painted;
  Frame frame;
  std::vector<std::uint64_t> pixels;  // ExitWord
};

struct Out {
  std::uint32_t color;
  bool user, last;
  bool operator==(const Out&) const = default;
};

struct Load {
  std::uint32_t color;
  int x;
  bool last;
  bool operator==(const Load&) const = default;
};

using Table = std::vector<std::array<std::array<std::uint32_t, 3>, 8>>;  // share by class, light, channel

/// The part of a channel that a pixel keeps, in 2^-shade_frac.
std::uint32_t factor(const Shape& s, std::uint64_t pixel, const Table& table, std::uint32_t shade,
                     std::size_t channel) {
  const std::int64_t one = std::int64_t{1} << s.shade_frac;
  std::int64_t kept = one;
  const ExitWord exit(s);
  if (s.count_bits == 0) {
    if (get(pixel, exit.dark) != 0) kept -= shade;
    return static_cast<std::uint32_t>(kept);
  }
  const std::size_t normal_class = s.has_table() ? get(pixel, exit.normal_class) : 1;
  std::uint64_t counts = get(pixel, exit.counts);
  for (std::size_t light = 0; light < static_cast<std::size_t>(s.lights); ++light, counts >>= s.count_bits) {
    const std::int64_t share = s.has_table() ? table[normal_class][light][channel] : shade;
    kept -= share * static_cast<std::int64_t>(counts & ((1U << s.count_bits) - 1));
  }
  return static_cast<std::uint32_t>(std::max<std::int64_t>(kept, 0));
}

/// The colour that leaves for a pixel of a line.
std::uint32_t color_of(const Shape& s, const Line& l, std::uint64_t pixel, const Table& table) {
  const bool drawn = get(pixel, ExitWord(s).covered) != 0 || (s.translucency != 0 && l.painted);
  if (l.blank || !drawn) return l.frame.background;
  std::uint32_t color = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint64_t kept = (pixel >> 8 * c & 255) * factor(s, pixel, table, l.frame.shade, c);
    color |= static_cast<std::uint32_t>((kept + (1U << (s.shade_frac - 1))) >> s.shade_frac) << 8 * c;
  }
  return color;
}

/// Write a whole table, an entry a clock.
template <class Model>
void load_table(Bench<Model>& top, Dice& dice, const Shape& s, Table& table) {
  const TableEntryBus entry(s);
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

/// Lines of random frames go in as the frame's control announces them and the pixels fill them; all that comes out is
/// as expected.
template <class Model>
class Lines {
 public:
  explicit Lines(Dice& dice)
      : dice_(dice), top_(dice), in_stall_(stall_percent(dice)), out_stall_(stall_percent(dice)) {}

  void run() {
    for (int clock = 0; made_ < kMost || !expected_.empty() || !loads_.empty(); ++clock) {
      REQUIRE(clock < 100000);
      // A new table waits for all lines of the frame before.
      const bool none = announced_.empty() && to_fill_.empty() && expected_.empty() && loads_.empty();
      const bool may_begin = left_ > 0 || none || !kShape.has_table();
      if (kShape.has_table() && left_ == 0 && made_ < kMost && none) load_table(top_, dice_, kShape, table_);
      if (made_ < kMost && announced_.size() < 3 && may_begin) make();
      announce();
      fill();
      top_->m_axis_tready_i = dice_.percent(out_stall_) ? 0 : 1;
      top_->load_ready_i = dice_.percent(out_stall_) ? 0 : 1;
      top_.settle();
      look();
      edge();
    }
  }

 private:
  static constexpr Shape kShape{config_of<Model>()};
  static constexpr LineBus kLine{kShape};
  static constexpr ExitWord kExit{kShape};
  static constexpr LoadBus kLoad{kShape};
  static constexpr int kMost = 14;  // lines

  /// One more line, of the frame at hand or of a new one: how it goes in, and what is expected of it.
  void make() {
    Line l{};
    l.first = left_ == 0;
    if (l.first) {
      frame_.width = dice_.percent(30) ? kShape.max_width : dice_.between(1, kShape.max_width);
      left_ = dice_.between(1, 4);
      frame_.background = static_cast<std::uint32_t>(dice_.bits(24));
      frame_.shade = dice_.percent(30) ? 1U << kShape.shade_frac  //
                                       : static_cast<std::uint32_t>(dice_.bits(kShape.shade_frac));
    }
    --left_;
    l.blank = dice_.percent(20);
    l.load = kShape.has_loads() && dice_.percent(30);
    l.painted = !l.load && dice_.percent(30);
    l.frame = frame_;
    for (int x = 0; x < l.frame.width; ++x) {
      l.pixels.push_back(random_pixel());
      const std::uint32_t color = color_of(kShape, l, l.pixels.back(), table_);
      const bool last = x == l.frame.width - 1;
      if (l.load)
        loads_.push_back({color, x, last});
      else
        expected_.push_back({color, l.first && x == 0, last});
    }
    announced_.push_back(l);
    to_fill_.push_back(l);
    ++made_;
  }

  std::uint64_t random_pixel() {
    std::uint64_t pixel = dice_.bits(kShape.pixel_bits());
    if (kShape.has_table() && get(pixel, kExit.normal_class) == 0) put(pixel, kExit.counts, 0);
    return pixel;
  }

  void announce() {
    top_->line_valid_i = announced_.empty() ? 0 : 1;
    if (announced_.empty()) return;
    const Line& l = announced_.front();
    put(top_->line_i, kLine.first, l.first ? 1 : 0);
    put(top_->line_i, kLine.blank, l.blank ? 1 : 0);
    put(top_->line_i, kLine.painted, l.painted ? 1 : 0);
    put(top_->line_i, kLine.load, l.load ? 1 : 0);
    put(top_->line_i, kLine.width, static_cast<std::uint64_t>(l.frame.width));
    put(top_->line_i, kLine.background, l.frame.background);
    put(top_->line_i, kLine.shade, l.frame.shade);
  }

  /// One line at a time takes a buffer and then comes in, group by group, as from the pixels.
  void fill() {
    top_->exit_take_i = 0;
    top_->exit_valid_i = 0;
    top_.settle();
    if (!filling_ && !to_fill_.empty() && top_->exit_free_o && !dice_.percent(in_stall_)) top_->exit_take_i = 1;
    if (!filling_) return;
    const Line& l = to_fill_.front();
    top_->exit_valid_i = 1;
    for (int lane = 0; lane < kShape.lanes; ++lane) {
      const int x = filled_ + lane;
      put(top_->exit_data_i, kShape.pixel_bits() * lane, kShape.pixel_bits(),
          x < l.frame.width ? l.pixels[static_cast<std::size_t>(x)] : dice_.bits(kShape.pixel_bits()));
    }
    top_->exit_last_i = filled_ + kShape.lanes >= l.frame.width ? 1 : 0;
  }

  /// An offer stays until it is taken, and is the expected one.
  void look() {
    const Out now{top_->m_axis_tdata_o, top_->m_axis_tuser_o != 0, top_->m_axis_tlast_o != 0};
    if (waited_) {
      REQUIRE(top_->m_axis_tvalid_o);
      REQUIRE(now == before_);
    }
    waited_ = top_->m_axis_tvalid_o && !top_->m_axis_tready_i;
    before_ = now;
    if (top_->m_axis_tvalid_o && top_->m_axis_tready_i) {
      REQUIRE(!expected_.empty());
      REQUIRE(now.color == expected_.front().color);
      REQUIRE(now == expected_.front());
      expected_.pop_front();
    }
    if (top_->load_valid_o) REQUIRE(!loads_.empty());
    if (top_->load_valid_o && top_->load_ready_i) {
      const Load load{static_cast<std::uint32_t>(get(top_->load_o, kLoad.color)),
                      static_cast<int>(get(top_->load_o, kLoad.x)), get(top_->load_o, kLoad.last) != 0};
      REQUIRE(load == loads_.front());
      loads_.pop_front();
    }
  }

  void edge() {
    const bool line_taken = top_->line_valid_i && top_->line_ready_o;
    const bool take = top_->exit_take_i;
    const bool complete = top_->exit_valid_i && top_->exit_last_i;
    const bool group = top_->exit_valid_i && !complete;
    top_.edge();
    if (line_taken) announced_.pop_front();
    if (take) filling_ = true, filled_ = 0;
    if (complete) filling_ = false, to_fill_.pop_front();
    if (group) filled_ += kShape.lanes;
  }

  Dice& dice_;
  Bench<Model> top_;
  int in_stall_, out_stall_;
  Table table_;
  Frame frame_;
  int left_ = 0, made_ = 0;               // lines of the frame at hand that are not made; lines made
  std::deque<Line> announced_, to_fill_;  // lines that have not been taken, that are not full
  bool filling_ = false;                  // the first of to_fill_ has its buffer
  int filled_ = 0;                        // pixels of it
  std::deque<Out> expected_;
  std::deque<Load> loads_;
  bool waited_ = false;  // what is offered was not taken
  Out before_{};
};

template <class Model>
void line_test() {
  each_seed(15, [](Dice& dice) { Lines<Model>(dice).run(); });
}

}  // namespace

TEST_CASE("line_out, groups of four", "[line_out]") { line_test<Vline_out4>(); }
TEST_CASE("line_out, single pixels", "[line_out]") { line_test<Vline_out1>(); }

TEST_CASE("line_out, one counter, no table", "[line_out]") { line_test<Vline_out_soft1>(); }
TEST_CASE("line_out, counters of three lights, table, loads", "[line_out]") { line_test<Vline_out_lights4>(); }

TEST_CASE("line_out sends the lines of a frame without a gap", "[line_out]") {
  each_seed(2, [](Dice& dice) {
    Bench<Vline_out4> top(dice);
    constexpr LineBus line(config_of<Vline_out4>());
    const int width = 16, lines = 10;
    int announced = 0, groups = 0, taken = 0, pixels = 0, first = 0, last = 0;
    top->m_axis_tready_i = 1;
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
      if (top->m_axis_tvalid_o) {
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
