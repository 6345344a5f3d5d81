// SPDX-License-Identifier: Apache-2.0
// Every parameter of a plan says what stands against one less of it, and how far a plan is, is told as it goes on.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "kage/plan.hpp"
#include "test/scene/planned_scenes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

TEST_CASE("what a reason says of one less holds of the scene, for every parameter") {
  for (const std::string& input : inputs())
    for (const Prefer prefer : {Prefer::area, Prefer::words}) {
      CAPTURE(input);
      const std::array scenes{small(input, 80, 60, 1)};
      PlanOptions options;
      options.prefer = prefer;
      const Plan plan = make_plan(scenes, options);
      CHECK(reasoned_of(plan) == reasoned(plan));
      for (const PlanReason& r : plan.reasons) check_one_less(plan, r, scenes[0]);
    }
}

TEST_CASE("the share that is done rises from nothing to all, and with every frame once all passes are known") {
  // A way more than was expected first (penumbra) holds the share for a pass; from there on it rises.
  for (const char* input : {"courtyard", "penumbra", "depths"}) {
    CAPTURE(input);
    const std::array scenes{small(input, 32, 24, 3)};
    std::vector<double> told;
    PlanOptions options;
    options.progress = [&](double share) { told.push_back(share); };
    make_plan(scenes, options);
    CHECK(told.front() == 0);
    CHECK(std::is_sorted(told.begin(), told.end()));
    const auto all = static_cast<double>(told.size());
    CHECK(told.back() == (all - 1) / all);
    for (std::size_t i = 2 * told.size() / 3; i + 1 < told.size(); ++i) CHECK(told[i] < told[i + 1]);
  }
}

}  // namespace kage::verif
