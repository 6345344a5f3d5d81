// SPDX-License-Identifier: Apache-2.0
//
// Shared parts of the tests of plans: the scenes, and how a reason is read.
#pragma once

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kage/error.hpp"
#include "kage/plan.hpp"
#include "test/support/catch.hpp"
#include "test/support/installed.hpp"

namespace kage::verif {

/// Every built-in scene and four meshes.
inline std::vector<std::string> inputs() {
  std::vector<std::string> list = builtin_scenes();
  for (const char* mesh : {"horse.3ds", "bunny.obj", "cat.3ds", "asteroid-low.3ds"})
    if (present(glmark2(mesh))) list.push_back(glmark2(mesh));
  return list;
}

/// A scene, drawn small.
inline PlannedScene small(const std::string& input, int width, int height, int frames) {
  PlannedScene scene;
  scene.scene = std::make_shared<const Scene>(Scene::load(input));
  scene.draw.width = width;
  scene.draw.height = height;
  scene.draw.frames = frames;
  return scene;
}

/// The reason of a parameter.
inline const PlanReason& reason(const Plan& plan, std::string_view parameter) {
  for (const PlanReason& r : plan.reasons)
    if (r.parameter == parameter) return r;
  FAIL("no reason for " << parameter);
  return plan.reasons[0];
}

/// The parameters that a plan gives reasons of: without units, none of theirs.
inline std::vector<std::string_view> reasoned(const Plan& plan) {
  std::vector<std::string_view> names;
  for (const ParamInfo& p : kParams)
    if (plan.config.units > 0 ||
        std::string_view(",FACE_BITS,DX_BITS,SEG_BITS,ORDER_BITS,CLASSIC,").find("," + std::string(p.name) + ",") ==
            std::string_view::npos)
      names.push_back(p.name);
  return names;
}

/// Likewise those that it does give.
inline std::vector<std::string_view> reasoned_of(const Plan& plan) {
  std::vector<std::string_view> names;
  for (const PlanReason& r : plan.reasons) names.push_back(r.parameter);
  return names;
}

/// The number in front of a phrase of a reason: what is needed before it is rounded up to a step.
inline int before(const std::string& text, const std::string& phrase) {
  const std::size_t at = text.find(phrase);
  REQUIRE(at != std::string::npos);
  std::size_t from = at;
  while (from > 0 && std::isdigit(static_cast<unsigned char>(text[from - 1])) != 0) --from;
  REQUIRE(from < at);
  return std::stoi(text.substr(from, at - from));
}

/// Whether a scene cannot be drawn with a parameter's value, what else there is being as it is, or less where the rules
/// between parameters ask for that.
inline bool refused(const PlannedScene& scene, Config config, int Config::*member, int value) {
  config.*member = value;
  config.max_width = std::min(config.max_width, (1 << config.x_bits) - 1);
  for (const RuleInfo& rule : kRules)
    if (!rule.holds(config)) rule.repair(config);
  try {
    validate(config, "one less");
    SceneFrames frames(scene.scene, config, scene.draw);
    for (int i = 0; i < frames.frames(); ++i) {
      const SceneFrame frame = scene.scene->frame(i, frames.frames());
      if (!lacks(config, needs_of(*scene.scene, frame, scene.draw.width, scene.draw.height, scene.draw.look.samples))
               .empty())
        return true;
      frames.words(i);
    }
  } catch (const Error&) {
    return true;
  }
  return false;
}

/// Checks that a reason says why its parameter is not one less: a limit that was passed, in a picture or by an
/// inequality; the scene, which is then tried; the costs. Or it says that there is none less.
inline void check_one_less(const Plan& plan, const PlanReason& r, const PlannedScene& scene) {
  const ParamInfo& p =
      *std::find_if(kParams.begin(), kParams.end(), [&](const ParamInfo& q) { return q.name == r.parameter; });
  CAPTURE(p.name, r.value, r.text);
  const auto says = [&](const char* phrase) { return r.text.find(phrase) != std::string::npos; };
  const char* cannot = " cannot represent the scene";
  if (says(cannot)) {
    const int less = before(r.text, cannot);
    CHECK(less < r.value);
    CHECK(refused(scene, plan.config, p.member, less));
    return;
  }
  bool said = r.value == p.min;
  if (p.member == &Config::class_bits && says("; without a table pictures give ")) said = says(" (over --max-");
  for (const char* phrase :
       {" (over --max-", ", more than --max-", "no SHADE_FRAC keeps --max-color", "would put classes together",
        "have no room for that", "is another way, and costed too", " would take ", "both arrangements show the same",
        "systolic: without effect", "no units", "no core has fewer"})
    said = said || says(phrase);
  // Rounded up to a step from the least that is legal.
  for (const char* phrase : {" bits hold", " bit holds", " keep ", " are off by ", " show colours"})
    said = said || (says(phrase) && before(r.text, phrase) <= p.min);
  CHECK(said);
}

}  // namespace kage::verif
