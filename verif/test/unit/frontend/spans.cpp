// SPDX-License-Identifier: Apache-2.0
// A span's start and step are the same whether 64 bits hold the sums on the way there or not.
#include <algorithm>
#include <vector>

#include "frontend/span_setup.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

struct Part {
  int xl;
  int xr;
  SpanSetup::Ramp ramp;
};

std::int64_t about(Random& random, int log) {
  const int bits = random.in(0, log);
  return static_cast<std::int64_t>(random.real(-1, 1) * static_cast<double>(std::int64_t{1} << bits));
}

}  // namespace

TEST_CASE("a span that stays in range is one part, with the ramp that 128 bits give") {
  Random random(test_seed());
  CAPTURE(test_seed());
  int one = 0;
  int more = 0;
  for (int round = 0; round < 200'000; ++round) {
    const int frac = random.in(0, 16);
    const int bits = random.in(4, 28) + frac + 2;
    const SpanSetup setup(frac, bits, frac);
    // On both sides of what 64 bits hold, often right at it.
    ScreenPlane p;
    p.a = random.chance(0.2) ? (std::int64_t{1} << 44) + random.in(-2, 2) : about(random, 50);
    p.b = random.chance(0.2) ? -(std::int64_t{1} << 44) + random.in(-2, 2) : about(random, 50);
    p.c = random.chance(0.2) ? (std::int64_t{1} << 60) + random.in(-2, 2) : about(random, 62);
    p.x0 = random.in(-32768, 32768);
    p.y0 = random.in(-32768, 32768);
    const int xl = random.in(0, 32765);
    const int xr = random.chance(0.5) ? xl + 1 : random.in(xl + 1, 32766);
    const int y = random.in(0, 32765);
    if (random.chance(0.8)) {
      // Where spans are: within depth, about the anchor.
      p.a = std::clamp(p.a, -(std::int64_t{1} << 40), std::int64_t{1} << 40);
      // Where b is steep that is more than 64 bits hold; what is left of it then is as good as any.
      const Int128 c =
          about(random, bits - frac - 2 + kPlaneFrac) - Int128{p.a} * (xl - p.x0) - Int128{p.b} * (y - p.y0);
      p.c = static_cast<std::int64_t>(c);
    }
    CAPTURE(round, frac, bits, p.a, p.b, p.c, p.x0, p.y0, xl, xr, y);
    std::vector<Part> parts;
    setup.each(p, xl, xr, y, [&](int from, int to, SpanSetup::Ramp r) { parts.push_back({from, to, r}); });
    const Int128 limit = Int128{1} << (bits - 1);
    const auto start = [&](int x) {
      const Int128 half = kPlaneFrac > frac ? Int128{1} << (kPlaneFrac - frac - 1) : 0;
      return ((value_at(p, x, y) + half) >> (kPlaneFrac - frac)) + (frac > 0 ? Int128{1} << (frac - 1) : 0);
    };
    const auto region = [&](int x) { return start(x) < -limit ? -1 : start(x) >= limit ? 1 : 0; };
    REQUIRE(parts.front().xl == xl);
    REQUIRE(parts.back().xr == xr);
    if (region(xl) == 0 && region(xr - 1) == 0) REQUIRE(parts.size() == 1);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Part& part = parts[i];
      if (i > 0) REQUIRE(part.xl == parts[i - 1].xr);
      const SpanSetup::Ramp wide = setup.at(p, part.xl, y, part.xr - part.xl);
      REQUIRE(region(part.xl) == region(part.xr - 1));
      REQUIRE(part.ramp.start == wide.start);
      REQUIRE(part.ramp.step == (region(part.xl) == 0 ? wide.step : 0));
    }
    ++(parts.size() == 1 ? one : more);
  }
  CHECK(one > 100'000);
  CHECK(more > 1'000);
}

}  // namespace kage::verif
