// SPDX-License-Identifier: Apache-2.0
//
// Depth planes against the depths of their corners in exact arithmetic (docs/numbers.md, "The plane").
#pragma once

#include "extremes/family.hpp"
#include "kage/geometry.hpp"

namespace kage::verif {

/// The drawn polygons of more than three corners, whose planes are unsnapped. Its items are corners.
Outcome unsnapped_planes_hold(const SceneFrame& f, const Config& config, int width, int height, const Look& look,
                              const Context& context);

/// The sides of the shadow volumes of the first light sample, whose planes may be unsnapped or go through snapped
/// corners. Its items are corners.
Outcome sides_hold(const SceneFrame& f, const Config& config, int width, int height, Look look, const Context& context);

}  // namespace kage::verif
