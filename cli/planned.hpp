// SPDX-License-Identifier: Apache-2.0
//
// --config plan: a configuration that is planned for the scene.
#pragma once

#include <memory>
#include <string>

#include "kage/config.hpp"
#include "kage/plan.hpp"
#include "options.hpp"
#include "progress.hpp"

namespace kage::cli {

/// What --config says for it.
inline constexpr const char* kPlanned = "plan";

/// A scene as a plan takes it, drawn as the options say. `progress` must outlive it.
PlannedScene planned_scene(const Options& options, std::shared_ptr<const Scene> scene, Progress& progress);

/// The progress of a plan, which can be interrupted. `progress` must outlive it.
std::function<void(double)> plan_progress(Progress& progress);

/// What `kage plan` finds for the scene without further options. Its name is kPlanned.
NamedConfig planned_config(const Options& options, std::shared_ptr<const Scene> scene);

}  // namespace kage::cli
