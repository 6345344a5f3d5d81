// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace kage::scene {

/// Cut a polygon into corner.size() - 2 triangles that keep its winding; numbers are into `corner`. It may be concave
/// and not quite planar. One that crosses itself is cut too, into something.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<glm::dvec3>& corner);

/// Whether two edges of a polygon that share no corner cross, seen along its mean normal, by more than what single
/// precision leaves of a place. One of so many edges that this would take long is said not to.
bool crosses_itself(const std::vector<glm::dvec3>& corner);

/// A sentence on polygons that cross themselves, if there are any.
void note_crossing(std::size_t count, std::vector<std::string>& notes);

}  // namespace kage::scene
