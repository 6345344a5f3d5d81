// SPDX-License-Identifier: Apache-2.0
// Figures beside their limits: text that shows on which side they lie.
#include "plan/figures.hpp"

#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <string>

#include "test/support/catch.hpp"

using namespace kage::plan;

TEST_CASE("a figure and its limit are told apart in as few digits as do") {
  CHECK(told_apart(3.01234e-8, 5.96046e-8).value == "3.01e-08");
  CHECK(told_apart(5.9605e-8, 5.9604e-8).value == "5.9605e-08");
  CHECK(told_apart(5.9605e-8, 5.9604e-8).limit == "5.9604e-08");
  CHECK(told_apart(1.0004, 1, 2).value == "1.0004");
  CHECK(told_apart(0.5, 0.5).value == "0.5");
}

TEST_CASE("the text of unequal figures differs, and is on the side of the limit on which the figure is") {
  rc::check("told_apart()", [] {
    const double limit = *rc::gen::inRange(1, 1000000) * 1e-9;
    double value = limit;
    const int steps = *rc::gen::inRange(-3, 4);
    for (int i = 0; i < std::abs(steps); ++i)
      value = std::nextafter(value, steps < 0 ? 0 : std::numeric_limits<double>::infinity());
    const FigureText text = told_apart(value, limit);
    RC_ASSERT((text.value == text.limit) == (value == limit));
    RC_ASSERT((std::stod(text.value) > std::stod(text.limit)) == (value > limit));
  });
}
