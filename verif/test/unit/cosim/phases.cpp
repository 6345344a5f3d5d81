// SPDX-License-Identifier: Apache-2.0
// Clocks of a frame by design, line by line: the numbers are counted by hand from docs/rtl.md, "Clocks".
#include "cosim/phases.hpp"

#include <vector>

#include "kage/config.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::cosim;

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

TEST_CASE("before its TPs a line's colours come back", "[phases]") {
  for (const int lanes : {1, 4}) {
    PhaseCounter counter(config_of(1, lanes));
    counter.start(64);
    counter.token(span(Kind::TP, 5, 6));
    counter.token(plain(Kind::EOL));
    counter.token(plain(Kind::EOL));
    const std::uint64_t groups = 64 / static_cast<std::uint64_t>(lanes);
    CHECK(counter.lines() == std::vector<std::uint64_t>{64 + std::max<std::uint64_t>(64, 2 * groups) + 32, 64});
  }
  PhaseCounter systolic(config_of(0, 1));
  systolic.start(64);
  systolic.token(span(Kind::TP, 5, 6));
  systolic.token(plain(Kind::EOL));
  CHECK(systolic.lines() == std::vector<std::uint64_t>{2 * 64 + 32});
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
