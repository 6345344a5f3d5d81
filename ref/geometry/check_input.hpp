// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kage/geometry.hpp"

namespace kage {

/// Throws Error if a vertex, the camera or a light is not as its type says, or a light is too far away.
void check_finite(const SceneFrame& frame);

/// Throws Error if a number of the look is out of its range.
void check_look(const Look& look);

}  // namespace kage
