// SPDX-License-Identifier: Apache-2.0
// Measured plans of every built-in scene and of four meshes: what is kept is within the limits, and every width one
// less is over one, or cannot represent the scene.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "kage/plan.hpp"
#include "test/scene/planned_scenes.hpp"
#include "test/support/catch.hpp"
#include "trade/measured_plan.hpp"

namespace kage::verif {

TEST_CASE("measured: what is kept is within the limits, and every width one less is not") {
  for (const std::string& input : inputs()) {
    CAPTURE(input);
    const std::array scenes{small(input, 64, 48, 1)};
    const trade::MeasuredLimits limits{2000.0, 1e-3, 3};
    trade::MeasuredPlan measured(scenes, limits, [] {});
    PlanOptions options;
    options.limits.color = limits.color;
    std::vector<Config> raw;
    options.lower = [&](Config& widths, std::vector<PlanReason>& reasons) {
      measured.lower(widths, reasons);
      Config least = widths;
      for (const PlanReason& r : reasons)
        if (r.text.rfind("measured: ", 0) == 0)
          for (const ParamInfo& p : kParams)
            if (p.name == r.parameter) least.*(p.member) = before(r.text, " give ");
      raw.push_back(least);
    };
    const Plan plan = make_plan(scenes, options);
    CHECK(measured.within(measured.measure(plan.config, true).value()));
    for (const Config& least : raw) {
      const auto kept = measured.measure(least, true);
      REQUIRE(kept);
      CHECK(measured.within(*kept));
      for (int Config::*member : {&Config::z_bits, &Config::z_frac, &Config::color_frac, &Config::shade_frac}) {
        const ParamInfo& p =
            *std::find_if(kParams.begin(), kParams.end(), [&](const ParamInfo& q) { return q.member == member; });
        Config less = least;
        less.*member -= 1;
        if (less.*member < p.min || (member == &Config::color_frac && least.smooth == 0) ||
            (member == &Config::shade_frac && least.dsf_bits == 0))
          continue;
        const auto a = measured.measure(less, true);
        CAPTURE(p.name, least.*member);
        CHECK_FALSE((a && measured.within(*a)));
      }
    }
  }
}

}  // namespace kage::verif
