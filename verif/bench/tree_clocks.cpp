// SPDX-License-Identifier: Apache-2.0
// Clocks that lines with a tree cost in the whole core, for 1 to 64 units, beside the clocks of what feeds the units:
// docs/tree.md, "The clocks of a line". Exit 1 if one is not as stated, or a pixel is wrong.
//
// usage: bench_tree_clocks [UNITS...]    only cores of so many units, banked and systolic
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "bench/counted_core.hpp"
#include "cost/token_clocks.hpp"
#include "kage/config.hpp"
#include "kage/stream.hpp"

namespace {

using namespace kage;

constexpr int kBankedFrame = 31;  // header, pipelines, way out
constexpr int kSystolicFrame = 28;

/// A frame of `lines` lines, each `segments` segments of every unit and a TREE, a line ahead as a front end writes
/// them.
std::vector<std::uint32_t> frame(const Config& c, int width, int lines, int segments) {
  std::vector<std::uint32_t> words;
  TokenWriter w(c, words);
  w.header({width, lines, 0xC0A080, 0});
  SegmentToken t;
  for (t.unit = 0; t.unit < c.units; ++t.unit) {
    t.color = {255 - t.unit, 100 + t.unit, 50};  // so that what a core draws shows
    w.face(t);
  }
  const auto line = [&] {
    for (t.unit = 0; t.unit < c.units; ++t.unit)
      for (int i = 0; i < segments; ++i) {
        t.sync = i == 0;
        t.dx = width * (i + 1) / segments - width * i / segments;
        t.z = 1000 + t.unit;
        w.seg(t);
      }
  };
  line();
  for (int y = 0; y < lines; ++y) {
    if (y + 1 < lines) line();
    w.tree();
    w.eol(y);
  }
  w.end();
  return words;
}

/// Counts of a core, beside what docs/tree.md states; false if one is not as stated.
bool core(const char* name, Config c, int units, int width) {
  c.units = units;
  c.max_width = width;
  bench::CountedCore counted(c);
  const auto clocks = [&](int pixels, int lines, int segments) {
    return counted.clocks(frame(c, pixels, lines, segments));
  };
  const int seg_words = Layout(c).words[static_cast<std::size_t>(Kind::SEG)];
  int levels = 0;
  while (1 << levels < units) ++levels;
  const int buffers = levels > 0 ? (levels - 1) / 2 : 0;  // of the tree
  bool good = true;
  const auto row = [&](const std::string& what, int words, int feeder, double taken, int least, int most) {
    const bool right = taken >= least && taken <= most;
    fmt::print("{:<9} {:>5} {:<23} {:>6} {:>12.1f} {:>7} {:>8.2f}  {}{}\n", name, units, what, words,
               static_cast<double>(words) / c.beat_words, feeder, taken,
               least == most ? fmt::format("{}", least) : fmt::format("{} .. {}", least, most),
               right ? "" : "  <-- differs");
    good = good && right;
  };
  const bool banked = c.arrangement == 1;
  // Lines behind each other: a hundred of them more, so that what a frame costs besides cancels.
  for (const int segments : {1, 4, 16}) {
    const int words = units * segments * seg_words;
    const int feeder = units * segments + 2;  // no token of these is wider than a beat; TREE and EOL
    const auto more = static_cast<double>(clocks(width, 108, segments) - clocks(width, 8, segments)) / 100;
    const int least = std::max(banked ? width + kBetweenTreeLines : width, feeder);
    row(fmt::format("line, {:>2} segments a unit", segments), words, feeder, more, least,
        banked ? least : width + feeder);
  }
  // A line alone, from header to last pixel. Banked, the tree makes it, then it leaves; systolic, it leaves at once.
  for (const int pixels : {1, width / 2, width}) {
    const int made = banked ? 2 * pixels + (pixels + c.lanes - 1) / c.lanes + kBankedFrame : pixels + kSystolicFrame;
    const int stated = 2 * units + levels + buffers + made;
    row(fmt::format("frame of {:>3} pixels", pixels), units * seg_words, 2 * units,
        static_cast<double>(clocks(pixels, 1, 1)), stated, stated);
  }
  return good && counted.same();
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> of_banked{1, 2, 4, 8, 16, 32, 64};
  std::vector<int> of_systolic{1, 4};
  if (argc > 1) {
    of_banked.clear();
    std::transform(argv + 1, argv + argc, std::back_inserter(of_banked), [](const char* n) { return std::atoi(n); });
    of_systolic = of_banked;
  }
  fmt::print("the whole core, BEAT_WORDS 4; banked: 8 lanes, lines of 256 pixels; systolic: 64 pixels\n");
  fmt::print("{:<9} {:>5} {:<23} {:>6} {:>12} {:>7} {:>8}  {}\n", "core", "units", "what", "words", "words / beat",
             "feeder", "clocks", "stated");
  bool as_stated = true;
  Config banked;
  banked.x_bits = 9;
  banked.lanes = 8;
  for (const int units : of_banked) as_stated = core("banked", banked, units, 256) && as_stated;
  Config systolic;
  systolic.x_bits = 9;
  systolic.arrangement = 0;
  for (const int units : of_systolic) as_stated = core("systolic", systolic, units, 64) && as_stated;
  fmt::print("{}\n", as_stated ? "all as stated" : "NOT as stated");
  return as_stated ? 0 : 1;
}
