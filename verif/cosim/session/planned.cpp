// SPDX-License-Identifier: Apache-2.0
#include "cosim/session/planned.hpp"

#include <fmt/format.h>

#include <array>

#include "cosim/session/order_build.hpp"
#include "cosim/session/source.hpp"

namespace kage::cosim {

PlannedScene planned_scene(const SourceOptions& options, std::shared_ptr<const Scene> scene, Host& host,
                           Progress& progress) {
  PlannedScene out;
  out.draw = draw_options(options);
  out.draw.level = Level::spans;  // which all that is costed is; PlanOptions::front_end asks for the other
  out.draw.order = order_build(options, host, progress, scene->name() + ": order of translucent faces");
  out.scene = std::move(scene);
  return out;
}

std::function<void(double)> plan_progress(Host& host, Progress& progress) {
  return [&host, &progress](double share) {
    host.check();
    progress.show(fmt::format("plan: {:.0f} %", 100 * share));
  };
}

NamedConfig planned_config(const SourceOptions& options, std::shared_ptr<const Scene> scene, Host& host) {
  const std::unique_ptr<Progress> progress = host.progress();
  const std::array scenes{planned_scene(options, std::move(scene), host, *progress)};
  PlanOptions plan;
  plan.progress = plan_progress(host, *progress);
  plan.front_end = options.level == Level::polygons;
  NamedConfig named{kPlanned, make_plan(scenes, plan).config};
  progress->clear();
  return named;
}

}  // namespace kage::cosim
