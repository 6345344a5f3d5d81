// SPDX-License-Identifier: Apache-2.0
//
// --config plan: a configuration that is planned for the scene.
#pragma once

#include <memory>
#include <string>

#include "kage/config.hpp"
#include "kage/cosim.hpp"
#include "kage/plan.hpp"

namespace kage::cosim {

/// The value of --config for it.
inline constexpr const char* kPlanned = "plan";

/// A scene as a plan takes it, drawn as the options say. `host` and `progress` must outlive it.
PlannedScene planned_scene(const SourceOptions& options, std::shared_ptr<const Scene> scene, Host& host,
                           Progress& progress);

/// The progress of a plan, which can be interrupted. `host` and `progress` must outlive it.
std::function<void(double)> plan_progress(Host& host, Progress& progress);

/// The configuration that `kage plan` finds for the scene without further options. Its name is kPlanned.
NamedConfig planned_config(const SourceOptions& options, std::shared_ptr<const Scene> scene, Host& host);

}  // namespace kage::cosim
