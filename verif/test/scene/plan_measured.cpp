// SPDX-License-Identifier: Apache-2.0
// Measured plans of every built-in scene and of four meshes: what is kept is within the limits, and every width one
// less is over one, or cannot represent the scene.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "contract/params.hpp"
#include "explore/measured_plan.hpp"
#include "kage/error.hpp"
#include "kage/plan.hpp"
#include "test/scene/planned_scenes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

TEST_CASE("measured: what is kept is within the limits, and every width one less is not") {
  for (const std::string& input : inputs()) {
    CAPTURE(input);
    const std::array scenes{small(input, 64, 48, 1)};
    const explore::MeasuredLimits limits{2000.0, 1e-3, 3};
    explore::MeasuredPlan measured(scenes, limits, [] {});
    PlanOptions options;
    options.limits.color = limits.color;
    std::vector<Config> raw;
    options.lower = [&](Config& widths, std::vector<PlanReason>& reasons) {
      std::string unkept = measured.lower(widths, reasons);
      Config least = widths;
      for (const PlanReason& r : reasons)
        if (r.text.rfind("measured: ", 0) == 0)
          for (const ParamInfo& p : kParams)
            if (p.name == r.parameter) least.*(p.member) = before(r.text, " give ");
      raw.push_back(least);
      return unkept;
    };
    const Plan plan = make_plan(scenes, options);
    CHECK(plan.limits.color == limits.color);
    CHECK(reasoned_of(plan) == reasoned(plan));
    for (const PlanReason& r : plan.reasons) check_one_less(plan, r, scenes[0]);
    const explore::MeasuredErrors taken = measured.measure(plan.config, true).value();
    CHECK(measured.within(taken));
    const explore::MeasuredPlan::Lowered* lowered = measured.lowered(plan.config);
    REQUIRE(lowered != nullptr);
    CHECK(lowered->taken_gives.pictures.z_max == taken.pictures.z_max);
    CHECK(lowered->taken_gives.pictures.color_max == taken.pictures.color_max);
    CHECK(lowered->taken_gives.light.squares == taken.light.squares);
    CHECK(taken.light.pixels > 100);
    CHECK(lowered->taken_gives.pictures.wrong_ppm() == taken.pictures.wrong_ppm());
    for (const Config& least : raw) {
      const auto kept = measured.measure(least, true);
      REQUIRE(kept);
      CHECK(measured.within(*kept));
      for (int Config::*member :
           {&Config::z_bits, &Config::z_frac, &Config::color_frac, &Config::shade_frac, &Config::class_bits}) {
        const ParamInfo& p = info_of(member);
        Config less = least;
        less.*member -= 1;
        if (less.*member < p.min || (member == &Config::color_frac && least.smooth == 0) ||
            (member == &Config::shade_frac && least.dsf_bits == 0) ||
            (member == &Config::class_bits && less.class_bits < 2))
          continue;
        const auto a = measured.measure(less, true);
        CAPTURE(p.name, least.*member);
        CHECK_FALSE((a && measured.within(*a)));
      }
    }
  }
}

TEST_CASE("measured: where the bound's widths are too coarse, or there are none, the finest are tried") {
  // The bound keeps colours within two steps at best, and the pictures are within one.
  const std::array scenes{small("three-lights", 64, 48, 1)};
  for (const bool given : {false, true}) {
    const explore::MeasuredLimits limits{std::nullopt, 1.0 / ((1 << 24) - 3), 1};
    explore::MeasuredPlan measured(scenes, limits, [] {});
    PlanOptions options;
    options.limits.color_given = given;
    options.lower = [&](Config& widths, std::vector<PlanReason>& reasons) { return measured.lower(widths, reasons); };
    const Plan plan = make_plan(scenes, options);
    CHECK(plan.limits.color == 1);
    CHECK(measured.within(measured.lowered(plan.config)->taken_gives));
  }
}

TEST_CASE("measured: the limit that no widths keep is named with the figure that was measured") {
  const std::array scenes{small("courtyard", 64, 48, 1)};
  const auto message = [&](const explore::MeasuredLimits& limits) -> std::string {
    explore::MeasuredPlan measured(scenes, limits, [] {});
    PlanOptions options;
    options.limits.z = limits.z;
    options.lower = [&](Config& widths, std::vector<PlanReason>& reasons) { return measured.lower(widths, reasons); };
    try {
      make_plan(scenes, options);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  const std::string depth = message({std::nullopt, 1e-9, 1});
  CAPTURE(depth);
  CHECK(depth.find("the finest widths (Z_BITS 28, Z_FRAC 16, ") == 0);
  CHECK(depth.find(" (over --max-z 1e-09), colour by ") != std::string::npos);
  const std::string color = message({std::nullopt, 1e-6, -1});
  CAPTURE(color);
  CHECK(color.find(" (over --max-color -1)") != std::string::npos);
  CHECK(color.find("over --max-z") == std::string::npos);
}

}  // namespace kage::verif
