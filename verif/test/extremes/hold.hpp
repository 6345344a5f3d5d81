// SPDX-License-Identifier: Apache-2.0
//
// Cases of verif/extremes as assertions.
#pragma once

#include "extremes/family.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

/// A check's outcome: all holds.
inline void holds(const Outcome& o) {
  INFO(o.wrong);
  CHECK(o.wrong.empty());
}

/// One case.
template <IsCase Case>
Outcome holds(const Case& c) {
  const Outcome o = guarded([&] { return c.check(Context{}); });
  INFO(text_of(c));
  holds(o);
  return o;
}

/// Holds `count` cases of a family from the test's seed. Gives the sum of their outcomes.
template <IsCase Case>
Outcome cases_hold(int count) {
  Random random(test_seed());
  CAPTURE(test_seed());
  Outcome sum;
  for (int i = 0; i < count; ++i) {
    CAPTURE(i);
    const Case c = draw_case<Case>(random);
    const Outcome o = guarded([&] { return c.check(Context{}); });
    INFO(text_of(c));
    INFO(o.wrong);
    REQUIRE(o.wrong.empty());
    sum.add(o);
  }
  return sum;
}

}  // namespace kage::verif
