// SPDX-License-Identifier: Apache-2.0
#include "planned.hpp"

#include <fmt/format.h>

#include <array>

#include "order_build.hpp"
#include "signals.hpp"
#include "source.hpp"

namespace kage::cli {

PlannedScene planned_scene(const Options& options, std::shared_ptr<const Scene> scene, Progress& progress) {
  PlannedScene out;
  out.draw = draw_options(options);
  out.draw.level = Level::spans;  // which all that is costed is; PlanOptions::front_end asks for the other
  out.draw.order = order_build(options, progress, scene->name() + ": order of translucent faces");
  out.scene = std::move(scene);
  return out;
}

std::function<void(double)> plan_progress(Progress& progress) {
  return [&progress](double share) {
    check_interrupt();
    progress.show(fmt::format("plan: {:.0f} %", 100 * share));
  };
}

NamedConfig planned_config(const Options& options, std::shared_ptr<const Scene> scene) {
  Progress progress;
  const std::array scenes{planned_scene(options, std::move(scene), progress)};
  PlanOptions plan;
  plan.progress = plan_progress(progress);
  plan.front_end = options.level == Level::polygons;
  NamedConfig named{kPlanned, make_plan(scenes, plan).config};
  progress.clear();
  return named;
}

}  // namespace kage::cli
