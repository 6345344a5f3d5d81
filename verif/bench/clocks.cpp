// SPDX-License-Identifier: Apache-2.0
// Clocks that tokens and lines cost in the RTL, measured by differences between frames, beside what the design says.
// Exit 1 if one is not as designed, or a pixel is wrong.
//
// usage: bench_clocks [LANES...]    only cores of so many lanes; 0: systolic
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "bench/counted_core.hpp"
#include "contract/derived.hpp"
#include "kage/config.hpp"
#include "kage/stream.hpp"

namespace {

using namespace kage;

constexpr int kWidth = 64;
constexpr int kLines = 8;

enum class What { op, sp, nc, none };

/// A frame of kLines lines, `count` tokens of [xl, xr) in each. Each sort of token shows in the picture, so that a core
/// which leaves its work out sends wrong pixels: with parity an odd number of shadow spans, on a wall.
std::vector<std::uint32_t> frame(const Config& c, What what, int xl, int xr, int count, int lines = kLines) {
  std::vector<std::uint32_t> words;
  TokenWriter w(c, words);
  w.header({kWidth, lines, 0xC0A080, 0});
  const bool shadow = what == What::sp || what == What::nc;
  if (shadow) w.shade(derived::half_share(c));
  for (int y = 0; y < lines; ++y) {
    SpanToken s;
    s.color = {200, 150, 100};
    s.normal_class = 1;
    if (shadow) {
      s.xr = kWidth;
      s.z = std::int64_t{1} << (c.z_bits + c.z_frac - 1);
      w.op(s);
    }
    s.xl = xl;
    s.xr = xr;
    s.z = 1000;
    s.w = 1;
    for (int i = 0; i < count; ++i) {
      if (what == What::op) w.op(s);
      if (what == What::sp) w.sp(s);
      if (what == What::nc) w.nc(xl, xr, 1);
    }
    if (shadow) {
      w.ev(0, kWidth);
      w.resolve();
    }
    w.eol(y);
  }
  w.end();
  return words;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> cores{0, 1, 4, 8};
  if (argc > 1) {
    cores.clear();
    std::transform(argv + 1, argv + argc, std::back_inserter(cores), [](const char* n) { return std::atoi(n); });
  }
  fmt::print("{:<10} {:>5} {:>5} {:<6} {:>9} {:>6} {:>6} {:>14} {:>14}\n", "core", "lanes", "beat", "token", "range",
             "words", "groups", "clocks/token", "by design");
  bool as_designed = true;
  for (const int lanes : cores) {
    for (const int beat : {2, 4}) {
      Config c;
      c.arrangement = lanes == 0 ? 0 : 1;
      c.lanes = lanes == 0 ? 1 : lanes;
      c.beat_words = beat;
      c.max_width = kWidth;
      bench::CountedCore core(c);
      const auto clocks = [&](const std::vector<std::uint32_t>& words) {
        return static_cast<double>(core.clocks(words));
      };
      const Layout layout(c);
      for (const auto& [what, kind] : {std::pair{What::op, Kind::OP}, {What::sp, Kind::SP}, {What::nc, Kind::NC}})
        for (const auto& [xl, xr] : {std::pair{8, 8}, {8, 9}, {7, 9}, {3, 40}, {0, kWidth}}) {
          // 200 tokens a line more, kLines times: what a line costs besides cancels, once tokens and not pixels out
          // decide.
          const double per_token =
              (clocks(frame(c, what, xl, xr, 401)) - clocks(frame(c, what, xl, xr, 201))) / (200.0 * kLines);
          const int words = layout.words[static_cast<std::size_t>(kind)];
          const int groups = lanes == 0 || xl == xr ? 1 : (xr - 1) / lanes - xl / lanes + 1;
          const double by_design = std::max({1.0, static_cast<double>(groups), static_cast<double>(words) / beat});
          const bool right = std::abs(per_token - by_design) < 1e-9;
          as_designed = as_designed && right;
          fmt::print("{:<10} {:>5} {:>5} {:<6} {:>4}-{:<4} {:>6} {:>6} {:>14.4f} {:>14.4f}{}\n",
                     lanes == 0 ? "systolic" : "banked", lanes == 0 ? kWidth : lanes, beat,
                     kKindNames[static_cast<std::size_t>(kind)], xl, xr, words, groups, per_token, by_design,
                     right ? "" : "  <-- differs");
        }
      const double line =
          (clocks(frame(c, What::none, 0, 0, 0, 108)) - clocks(frame(c, What::none, 0, 0, 0, 8))) / 100.0;
      // A line whose tokens take longer than its pixels need to leave: what is added to their clocks is the price of
      // changing lines.
      const double busy =
          (clocks(frame(c, What::op, 0, 1, 400, 108)) - clocks(frame(c, What::op, 0, 1, 400, 8))) / 100.0;
      const double busy_tokens =
          400 * std::max(1.0, static_cast<double>(layout.words[static_cast<std::size_t>(Kind::OP)]) / beat);
      fmt::print(
          "{:<10} {:>5} {:>5} an empty line of {} pixels: {:.2f} clocks; changing lines adds {:.2f} clocks to a line "
          "of 400 tokens\n",
          lanes == 0 ? "systolic" : "banked", lanes == 0 ? kWidth : lanes, beat, kWidth, line, busy - busy_tokens);
      as_designed = as_designed && core.same();
    }
  }
  fmt::print("{}\n", as_designed ? "all as designed" : "NOT as designed");
  return as_designed ? 0 : 1;
}
