// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace kage::scene {

/// Cut a polygon into corner.size() - 2 triangles that keep its winding; numbers are into `corner`. It may be concave
/// and not quite planar. One that crosses itself is cut too, into something.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<glm::dvec3>& corner);

}  // namespace kage::scene
