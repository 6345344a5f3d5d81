// SPDX-License-Identifier: Apache-2.0
//
// Caps that hide none of each other from the light, put together to patches: the volume of a patch covers no point
// twice, which is what parity needs.
#pragma once

#include <span>
#include <vector>

#include "shadow/light_space.hpp"
#include "shadow/world_volume.hpp"

namespace kage {

/// Part `caps`, a component's, into patches of connected faces. Each patch is grown from the first cap left, in order
/// of distance along the mesh, by all that overlap none of it seen from the light. Whether two overlap is decided
/// exactly, from the vertices as they are. Caps whose corners do not go round once to the light's side, exactly, are
/// patches of their own. Time is about linear in the caps where those are small in the
/// light's view.
std::vector<std::vector<CapFace>> make_patches(const SceneFrame& frame, const LightPoint& light, const EdgeTable& edges,
                                               const LightSpace& space, std::span<const CapFace> caps);

}  // namespace kage
