// SPDX-License-Identifier: Apache-2.0
// pixel_core in both arrangements against an array of pixels: random commands, buffers that are not free, back-to-back
// work on the same pixels, and the clocks that commands take.
#include <algorithm>
#include <deque>

#include "Vpixel_banked1.h"
#include "Vpixel_banked4.h"
#include "Vpixel_systolic.h"
#include "bench.hpp"
#include "kage/defs.hpp"

using namespace kage::rtl;
using kage::Kind;

namespace {

struct Shape {
  int lanes;  // of the exit; 0: systolic
  int width, x_bits, z_bits, z_frac, channels, smooth, color_frac, dsf_bits, fsf;
};

struct Command {
  Kind kind;
  int xl, xr;
  std::uint64_t count, z, dz;
  std::uint64_t color[3], dcolor[3];
};

struct Pixel {
  std::uint64_t z, color[3];
  unsigned lit, dsf, fsf;
};

std::int64_t wrap(std::uint64_t v, int bits) { return static_cast<std::int64_t>(v << (64 - bits)) >> (64 - bits); }

/// The pixels, and the pixels that leave as {dark, covered, colour}.
class Reference {
 public:
  explicit Reference(const Shape& s) : s_(s), line_(static_cast<std::size_t>(s.width)) { clear(); }

  void apply(const Command& c, std::deque<std::uint64_t>& out) {
    const unsigned mask = (1U << s_.dsf_bits) - 1;
    for (int x = c.xl; x < c.xr; ++x) {
      Pixel& p = line_[static_cast<std::size_t>(x)];
      const auto dx = static_cast<std::uint64_t>(x - c.xl);
      const std::int64_t sum = wrap(c.z + dx * c.dz, s_.z_bits + s_.z_frac + 2);
      const auto z = static_cast<std::uint64_t>(std::clamp<std::int64_t>(sum >> s_.z_frac, 1, (1 << s_.z_bits) - 2));
      switch (c.kind) {
        case Kind::OP:
          if (z >= p.z) break;
          p.z = z;
          p.lit = c.count & 1;
          for (int ch = 0; ch < s_.channels; ++ch)
            p.color[ch] =
                s_.smooth == 0
                    ? c.color[ch]
                    : static_cast<std::uint64_t>(std::clamp<std::int64_t>(
                          wrap(c.color[ch] + dx * c.dcolor[ch], 10 + s_.color_frac) >> s_.color_frac, 0, 255));
          break;
        case Kind::SP:
          if (z < p.z) p.dsf = (p.dsf + static_cast<unsigned>(c.count)) & mask;
          break;
        case Kind::NC:
          p.dsf = (p.dsf + static_cast<unsigned>(c.count)) & mask;
          break;
        case Kind::EV:
          if (((p.dsf + c.count) & mask) != 0) p.fsf = 1;
          p.dsf = 0;
          break;
        default: {
          const bool covered = p.z != (1U << s_.z_bits) - 1;
          const bool shadow = s_.fsf != 0 ? p.fsf != 0 : ((p.dsf + c.count) & mask) != 0;
          std::uint64_t value = static_cast<std::uint64_t>(covered) << (8 * s_.channels);
          if (s_.dsf_bits > 0) value |= static_cast<std::uint64_t>(shadow && p.lit != 0) << (8 * s_.channels + 1);
          for (int ch = 0; ch < s_.channels; ++ch) value |= p.color[ch] << (8 * ch);
          out.push_back(value);
        }
      }
    }
    if (c.kind == Kind::EOL) clear();
  }

 private:
  void clear() {
    for (Pixel& p : line_) p = {(1U << s_.z_bits) - 1, {}, 0, 0, 0};
  }
  Shape s_;
  std::vector<Pixel> line_;
};

Command random_command(Dice& dice, const Shape& s, int width, int home) {
  static constexpr Kind kKinds[] = {Kind::OP, Kind::OP, Kind::OP, Kind::SP, Kind::SP, Kind::NC, Kind::EV};
  Command c{};
  c.kind = s.dsf_bits == 0 ? Kind::OP : kKinds[dice.below(s.fsf != 0 ? 7 : 6)];
  c.xl = dice.below(width);
  if (dice.percent(60)) c.xl = std::min(width - 1, home + dice.below(3));
  c.xr = dice.percent(60) ? std::min(width, c.xl + dice.between(1, 9)) : dice.between(c.xl + 1, width);
  const int bits = s.z_bits + s.z_frac + 2;
  const std::uint64_t mask = (1ULL << bits) - 1;
  c.z = (((1ULL << (s.z_bits - 1)) + dice.bits(3)) << s.z_frac) & mask;
  c.dz = dice.bits(s.z_frac + 2);
  if (dice.percent(50)) c.dz = (0 - c.dz) & mask;
  if (dice.percent(20)) c.z = dice.bits(bits);
  if (dice.percent(20)) c.dz = dice.bits(bits);
  c.count = dice.bits(std::max(s.dsf_bits, 1));
  for (int ch = 0; ch < s.channels; ++ch) {
    c.color[ch] = dice.bits(s.smooth != 0 ? 10 + s.color_frac : 8);
    c.dcolor[ch] = s.smooth != 0 ? dice.bits(10 + s.color_frac) : 0;
  }
  return c;
}

template <class Model>
void set_command(Model& top, const Shape& s, const Command& c) {
  const int ramp = s.smooth != 0 ? 10 + s.color_frac : 8;
  top.cmd_kind_i = static_cast<CData>(c.kind);
  put(top.cmd_xl_i, static_cast<std::uint64_t>(c.xl));
  put(top.cmd_xr_i, static_cast<std::uint64_t>(c.xr));
  put(top.cmd_count_i, c.count);
  put(top.cmd_z_i, c.z);
  put(top.cmd_dz_i, c.dz);
  for (int ch = 0; ch < s.channels; ++ch) {
    put(top.cmd_color_i, ch * ramp, ramp, c.color[ch]);
    if (s.smooth != 0) put(top.cmd_dcolor_i, ch * ramp, ramp, c.dcolor[ch]);
  }
}

template <class Model>
void pixel_test(const Shape& s) {
  each_seed(15, [&](Dice& dice) {
    Bench<Model> top(dice);
    Offer offer(stall_percent(dice));
    const int free_percent = 100 - stall_percent(dice);
    const int lanes = std::max(s.lanes, 1);
    const int exit_bits = 8 * s.channels + (s.dsf_bits > 0 ? 2 : 1);
    Reference reference(s);
    std::deque<std::uint64_t> expected;
    std::deque<int> widths;  // of lines that have not left
    int width = dice.between(1, s.width), home = 0, left = 0, lines = 0, x = 0;
    Command c{};
    bool have = false;
    for (int clock = 0; lines < 12 || !widths.empty(); ++clock) {
      REQUIRE(clock < 200000);
      if (!have && lines < 12) {
        if (left-- > 0) {
          c = random_command(dice, s, width, home);
        } else {
          c = Command{};
          c.kind = Kind::EOL;
          c.xr = width;
          c.count = s.fsf == 0 ? dice.bits(std::max(s.dsf_bits, 1)) : 0;
        }
        have = true;
      }
      top->cmd_valid_i = offer(dice, have) ? 1 : 0;
      set_command(*top, s, c);
      top->exit_free_i = dice.percent(free_percent) ? 1 : 0;
      top.settle();
      const bool taken = top->cmd_valid_i && top->cmd_ready_o;
      if (top->exit_take_o) REQUIRE(top->exit_free_i);
      if (top->exit_valid_o) {
        REQUIRE(!widths.empty());
        const int w = widths.front();
        for (int l = 0; l < lanes && x < w; ++l, ++x) {
          CAPTURE(x, l, w);
          const std::uint64_t got = get(top->exit_data_o, l * exit_bits, exit_bits);
          const std::uint64_t want = expected.front();
          expected.pop_front();
          const std::uint64_t covered = want >> (8 * s.channels) & 1;
          REQUIRE((got >> (8 * s.channels) & 1) == covered);
          if (covered != 0) REQUIRE(got == want);  // an uncovered pixel has any colour
        }
        REQUIRE(static_cast<bool>(top->exit_last_o) == (x == w));
        if (x == w) {
          x = 0;
          widths.pop_front();
        }
      }
      top.edge();
      if (taken) {
        offer.taken();
        have = false;
        reference.apply(c, expected);
        if (c.kind == Kind::EOL) {
          widths.push_back(width);
          width = dice.percent(30) ? s.width : dice.between(1, s.width);
          home = dice.below(width);
          left = dice.percent(30) ? 0 : dice.below(40);
          ++lines;
        }
      }
    }
    REQUIRE(expected.empty());
  });
}

/// Clocks from the first to the last of `n` equal commands, which come without a pause.
template <class Model>
int clocks_of(Dice& dice, const Shape& s, int xl, int xr, int n) {
  Bench<Model> top(dice);
  top->exit_free_i = 1;
  Command c{};
  c.kind = Kind::OP;
  c.xl = xl;
  c.xr = xr;
  set_command(*top, s, c);
  top->cmd_valid_i = 1;
  int first = 0, taken = 0, clock = 0;
  for (; taken < n + 64; ++clock) {  // the first 64 fill the stages before the walker, and outlast the sweep
    top.settle();
    if (top->cmd_ready_o && ++taken == 64) first = clock;
    top.edge();
  }
  return clock - 1 - first;
}

constexpr Shape kBanked1{1, 21, 5, 10, 3, 3, 1, 6, 2, 1};
constexpr Shape kBanked4{4, 37, 6, 12, 4, 3, 0, 0, 1, 1};
constexpr Shape kSystolic{0, 21, 5, 10, 3, 3, 1, 6, 3, 0};

}  // namespace

TEST_CASE("Banked, one lane, smooth, counting", "[pixel_core]") { pixel_test<Vpixel_banked1>(kBanked1); }
TEST_CASE("Banked, four lanes, flat, parity", "[pixel_core]") { pixel_test<Vpixel_banked4>(kBanked4); }
TEST_CASE("Systolic, smooth, counting, no FSF", "[pixel_core]") { pixel_test<Vpixel_systolic>(kSystolic); }

TEST_CASE("Clocks per command: groups touched, or one", "[pixel_core]") {
  each_seed(1, [](Dice& dice) {
    CHECK(clocks_of<Vpixel_banked4>(dice, kBanked4, 4, 8, 40) == 40);  // one group, again and again: no hazard stalls
    CHECK(clocks_of<Vpixel_banked4>(dice, kBanked4, 7, 9, 40) == 2 * 40);    // two pixels in two groups
    CHECK(clocks_of<Vpixel_banked4>(dice, kBanked4, 0, 37, 20) == 10 * 20);  // the line
    CHECK(clocks_of<Vpixel_banked1>(dice, kBanked1, 3, 9, 20) == 6 * 20);
    CHECK(clocks_of<Vpixel_systolic>(dice, kSystolic, 0, 21, 40) == 40);  // whatever the length
  });
}
