// SPDX-License-Identifier: Apache-2.0
// Axes of a sweep: what their values mean, and which are refused.
#include "explore/sweep_points.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "kage/error.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::explore;

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
  const Grid all = grid(base(), axes);
  REQUIRE(all.points.size() == 6);
  CHECK(all.left_out == 0);
  CHECK(all.points[5].value == "Z_BITS=24 LANES=16");
  CHECK(with_seeds(one, 3).size() == one.size());
  const auto seeds = with_seeds({with(base(), "SAMPLES", "4")}, 3);
  REQUIRE(seeds.size() == 3);
  CHECK(seeds[2].value == "4 seed 3");
}

TEST_CASE("a grid has the combinations whose values are those of their names") {
  // In either order of the axes.
  for (const bool turned : {false, true}) {
    CAPTURE(turned);
    const auto of = [turned](SweepAxis a, SweepAxis b) {
      std::vector<SweepAxis> axes{std::move(a), std::move(b)};
      if (turned) std::swap(axes[0], axes[1]);
      return grid(base(), axes);
    };
    const Grid color = of({"SMOOTH", {"0", "1"}}, {"COLOR_FRAC", {"0", "8"}});
    REQUIRE(color.points.size() == 3);
    CHECK(color.left_out == 1);
    CHECK(color.example.starts_with(turned ? "COLOR_FRAC=8 SMOOTH=0: COLOR_FRAC becomes 0"
                                           : "SMOOTH=0 COLOR_FRAC=8: SMOOTH becomes 1"));
    std::set<std::pair<int, int>> seen;
    for (const SweepPoint& p : color.points) {
      CHECK(p.value.find("SMOOTH=" + std::to_string(p.config.smooth)) != std::string::npos);
      CHECK(p.value.find("COLOR_FRAC=" + std::to_string(p.config.color_frac)) != std::string::npos);
      seen.emplace(p.config.smooth, p.config.color_frac);
    }
    CHECK(seen == std::set<std::pair<int, int>>{{0, 0}, {1, 0}, {1, 8}});

    const Grid counts = of({"DSF_BITS", {"0", "2"}}, {"COUNT_BITS", {"0", "4"}});
    CHECK(counts.points.size() == 3);
    for (const SweepPoint& p : counts.points) {
      CHECK(p.value.find("DSF_BITS=" + std::to_string(p.config.dsf_bits)) != std::string::npos);
      CHECK(p.value.find("COUNT_BITS=" + std::to_string(p.config.count_bits)) != std::string::npos);
    }
    const Grid samples = of({"SAMPLES", {"1", "3", "64"}}, {"COUNT_BITS", {"2", "8"}});
    CHECK(samples.points.size() == 5);
    CHECK(samples.left_out == 1);
    for (const SweepPoint& p : samples.points) CHECK(samples_of(p) == p.look.samples);
    const Grid classes = of({"CLASSES", {"7", "31"}}, {"CLASS_BITS", {"3", "5", "8"}});
    CHECK(classes.points.size() == 5);
    CHECK(classes.left_out == 1);
    // A processor for each column of the picture.
    const Grid columns = of({"ARRANGEMENT", {"systolic"}}, {"SIZE", {"64x48", "160x120"}});
    REQUIRE(columns.points.size() == 2);
    for (const SweepPoint& p : columns.points) CHECK(p.config.max_width == p.width);
    // A width that is too small for the base, and not for another size.
    const Grid narrow = of({"MAX_WIDTH", {"100"}}, {"SIZE", {"64x48", "160x120"}});
    REQUIRE(narrow.points.size() == 1);
    CHECK(narrow.points[0].width == 64);
    CHECK(narrow.points[0].config.max_width == 100);
  }
  const std::vector<SweepAxis> none{{"SAMPLES", {"64"}}, {"COUNT_BITS", {"2"}}};
  CHECK_THROWS_AS(grid(base(), none), Error);
  const std::vector<SweepAxis> bad{{"SMOOTH", {"1"}}, {"Z_BITS", {"99"}}};
  CHECK_THROWS_AS(grid(base(), bad), Error);
}

TEST_CASE("an axis that is named again has all of its values") {
  std::vector<SweepAxis> axes;
  add_axis(axes, {"Z_BITS", {"8"}});
  add_axis(axes, {"LANES", {"1"}});
  add_axis(axes, {"Z_BITS", {"9", "10"}});
  REQUIRE(axes.size() == 2);
  CHECK(axes[0].values == std::vector<std::string>{"8", "9", "10"});
  CHECK(grid(base(), axes).points.size() == 3);
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
