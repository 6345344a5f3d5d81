// SPDX-License-Identifier: Apache-2.0
// Clocks of a frame by design, line by line: the numbers are counted by hand from docs/rtl.md, "Clocks".
#include "cost/token_clocks.hpp"

#include <vector>

#include "kage/config.hpp"
#include "test/support/catch.hpp"

using namespace kage;

namespace {

Token span(Kind kind, int xl, int xr) {
  Token t;
  t.kind = kind;
  t.span.xl = xl;
  t.span.xr = xr;
  return t;
}

Token plain(Kind kind) {
  Token t;
  t.kind = kind;
  return t;
}

/// 64 pixels a line; beats so wide that no token's words count.
Config config_of(int arrangement, int lanes) {
  Config c;
  c.arrangement = arrangement;
  c.lanes = lanes;
  c.max_width = 64;
  c.beat_words = 8;
  c.translucency = 1;
  return c;
}

}  // namespace

TEST_CASE("a line takes the clocks of its tokens, or of its pixels, whichever are more", "[phases]") {
  PhaseCounter counter(config_of(1, 4));
  counter.start(64);
  counter.token(plain(Kind::EOL));  // 16 groups
  for (int i = 0; i < 4; ++i) counter.token(span(Kind::OP, 0, 64));
  counter.token(plain(Kind::EOL));                                     // 4 * 16 + 16
  for (int i = 0; i < 3; ++i) counter.token(span(Kind::OP, 3, 9));     // pixels 3 .. 8: groups 0, 1 and 2
  for (int i = 0; i < 60; ++i) counter.token(span(Kind::OP, 20, 24));  // group 5
  counter.token(plain(Kind::EOL));                                     // 3 * 3 + 60 + 16
  CHECK(counter.lines() == std::vector<std::uint64_t>{64, 80, 85});
  CHECK(counter.sums().video == 64 - 16);
  counter.start(64);
  CHECK(counter.lines().empty());
}

TEST_CASE("in the systolic arrangement a token takes a clock", "[phases]") {
  PhaseCounter counter(config_of(0, 1));
  counter.start(64);
  for (int i = 0; i < 70; ++i) counter.token(span(Kind::OP, 0, 64));
  counter.token(plain(Kind::EOL));
  CHECK(counter.lines() == std::vector<std::uint64_t>{71});
}

TEST_CASE("before a line's first TP a pass paints the line, and with counters its colours come back", "[phases]") {
  for (const bool counters : {false, true})
    for (const bool resolved : {false, true})
      for (const int lanes : {0, 1, 4}) {  // 0: systolic
        Config c = config_of(lanes == 0 ? 0 : 1, std::max(1, lanes));
        c.count_bits = counters ? 4 : 0;
        const std::uint64_t groups = lanes == 0 ? 1 : 64 / static_cast<std::uint64_t>(lanes);
        const std::uint64_t pass = lanes == 0 ? 64 : 2 * groups;  // of colours on their way back
        PhaseCounter counter(c);
        counter.start(64);
        if (resolved) counter.token(plain(Kind::RESOLVE));
        counter.token(span(Kind::TP, 5, 6));
        counter.token(span(Kind::TP, 5, 6));
        counter.token(plain(Kind::EOL));
        counter.token(plain(Kind::EOL));
        const std::uint64_t tokens = (resolved ? 1 : 0) + 2 + groups;
        const std::uint64_t back = counters && resolved ? 64 + std::max<std::uint64_t>(64, pass) + 32 : 0;
        CAPTURE(counters, resolved, lanes);
        CHECK(counter.lines() == std::vector<std::uint64_t>{std::max<std::uint64_t>(64, tokens + groups + back), 64});
      }
}

TEST_CASE("the worst neighbours are those with the greatest sum", "[phases]") {
  const std::vector<std::uint64_t> lines{1, 9, 1, 5, 6, 1};
  CHECK(worst_window(lines, 1) == 9);
  CHECK(worst_window(lines, 2) == 11);
  CHECK(worst_window(lines, 4) == 21);
  CHECK(worst_window(lines, 6) == 23);
  CHECK(worst_window(lines, 100) == 23);
  CHECK(worst_window({}, 2) == 0);
}

TEST_CASE("a TREE waits until the tree has made its line, a line ahead and a pixel a clock", "[phases]") {
  Config c = config_of(1, 4);
  c.units = 2;
  PhaseCounter counter(c);
  counter.start(64);
  const auto line = [&](int spans) {
    counter.token(plain(Kind::SEG));
    counter.token(plain(Kind::TREE));  // 16 groups
    for (int i = 0; i < spans; ++i) counter.token(span(Kind::OP, 0, 64));
    counter.token(plain(Kind::EOL));  // 16 groups
  };
  line(0);  // 1 + 68 + 16 + 16: the first line of a frame is begun with it
  line(3);  // 1, and 68 since the last TREE, which were 33 so far; 16 + 3 * 16 + 16
  line(5);  // 1, and nothing to wait for: 81 since the last TREE; 16 + 5 * 16 + 16
  line(0);  // nothing to wait for
  line(0);  // 33 since the last TREE
  CHECK(counter.lines() == std::vector<std::uint64_t>{101, 116, 113, 64, 68});
  // Without a buffer behind the tree a line's SEGs may all come before its pixels.
  c.arrangement = 0;
  PhaseCounter systolic(c);
  systolic.start(64);
  for (int i = 0; i < 5; ++i) systolic.token(plain(Kind::SEG));
  systolic.token(plain(Kind::TREE));
  systolic.token(plain(Kind::EOL));
  CHECK(systolic.lines() == std::vector<std::uint64_t>{69});
}
