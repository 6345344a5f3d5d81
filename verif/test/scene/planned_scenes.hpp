// SPDX-License-Identifier: Apache-2.0
//
// What tests of plans share: the scenes, and how a reason is read.
#pragma once

#include <cctype>
#include <memory>
#include <string>
#include <vector>

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

/// The number in front of a phrase of a reason: what is needed before it is rounded up to a step.
inline int before(const std::string& text, const std::string& phrase) {
  const std::size_t at = text.find(phrase);
  REQUIRE(at != std::string::npos);
  std::size_t from = at;
  while (from > 0 && std::isdigit(static_cast<unsigned char>(text[from - 1])) != 0) --from;
  REQUIRE(from < at);
  return std::stoi(text.substr(from, at - from));
}

}  // namespace kage::verif
