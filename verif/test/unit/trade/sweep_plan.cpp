// SPDX-License-Identifier: Apache-2.0
// Axes of a sweep: what their values mean, and which are refused.
#include "trade/sweep_plan.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "kage/error.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::trade;

namespace {

SweepPoint base() {
  SweepPoint p;
  p.look.fit = true;
  p = with(p, "SIZE", "320x240");
  p.axis = "base";
  p.value.clear();
  return p;
}

std::string refused(const std::string& axis, const std::string& value) {
  try {
    with(base(), axis, value);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a value takes with it what it needs") {
  CHECK(with(base(), "COLOR_FRAC", "4").config.smooth == 1);
  CHECK(with(base(), "SAMPLES", "16").config.count_bits == 5);
  CHECK(samples_of(with(base(), "SAMPLES", "16")) == 16);
  CHECK(samples_of(with(with(base(), "SAMPLES", "16"), "COUNT_BITS", "4")) == 1);
  const SweepPoint dark = with(with(base(), "CLASSES", "255"), "DSF_BITS", "0");
  CHECK(dark.config.fsf == 0);
  CHECK(dark.config.count_bits == 0);
  CHECK(dark.config.class_bits == 1);
  const SweepPoint large = with(base(), "SIZE", "4096x16");
  CHECK(large.config.max_width == 4096);
  CHECK(large.config.x_bits == 13);
  CHECK(with(base(), "ARRANGEMENT", "systolic").config.max_width == 320);
  CHECK(with(base(), "ORDER", "centroid").look.translucent == TranslucentWay::centroid);
}

TEST_CASE("what is no value of an axis is refused by its name") {
  using Catch::Matchers::ContainsSubstring;
  CHECK_THAT(refused("Z_BITS", "3"), ContainsSubstring("--axes Z_BITS: 3 is no whole number from 4 to 28"));
  CHECK_THAT(refused("LANES", "3"), ContainsSubstring("LANES"));
  CHECK_THAT(refused("MAX_WIDTH", "100"), ContainsSubstring("--axes MAX_WIDTH: 100 is not possible"));
  CHECK_THAT(refused("ORDER", "random"), ContainsSubstring("none of exact, centroid, submission"));
  CHECK_THAT(refused("SIZE", "320"), ContainsSubstring("no size like 320x240"));
  CHECK_THROWS_AS(parse_axis("DEPTH=1"), Error);
  CHECK_THROWS_AS(parse_axis("Z_BITS"), Error);
  CHECK_THROWS_AS(parse_axis("Z_BITS="), Error);
  CHECK(parse_axis("Z_BITS=12,16").values == std::vector<std::string>{"12", "16"});
}

TEST_CASE("axes alone, and their grid") {
  const std::vector<SweepAxis> axes{{"Z_BITS", {"12", "24"}}, {"LANES", {"1", "4", "16"}}};
  const auto one = alone(base(), axes);  // Z_BITS 24 and LANES 4 are the base
  REQUIRE(one.size() == 4);
  CHECK(one[0].axis == "base");
  CHECK(one[1].config.z_bits == 12);
  CHECK(one[1].config.lanes == base().config.lanes);
  const auto all = grid(base(), axes);
  CHECK(all.size() == 6);
  CHECK(all[5].value == "Z_BITS=24 LANES=16");
  CHECK(with_seeds(one, 3).size() == one.size());
  CHECK(with_seeds({with(base(), "SAMPLES", "4")}, 3).size() == 3);
}

TEST_CASE("the default points are legal, each there once, and some 60") {
  for (const bool rich : {false, true}) {
    Needs needs{.width = 320, .height = 240, .shadows = true, .several_volumes = true};
    SweepPoint from = base();
    if (rich) {
      needs.smooth = needs.color = needs.translucency = true;
      needs.samples = 15;
      from = with(with(from, "SAMPLES", "15"), "CLASSES", "127");
      from = with(from, "TRANSLUCENCY", "1");
    }
    const auto points = default_points(from, needs);
    CHECK(points.size() > 45);
    CHECK(points.size() < 90);
    std::set<std::string> texts;
    for (const SweepPoint& p : points) {
      CAPTURE(p.axis, p.value);
      CHECK_NOTHROW(validate(p.config, p.axis));
      CHECK(p.config.max_width >= p.width);
      CHECK(texts.insert(text_of(p)).second);
    }
  }
}
