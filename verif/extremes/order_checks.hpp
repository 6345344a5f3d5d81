// SPDX-License-Identifier: Apache-2.0
//
// Rules for any visibility order, and for the lines where planes cut faces.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "extremes/family.hpp"
#include "kage/order.hpp"
#include "kage/scene.hpp"

namespace kage::verif {

/// n faces give at most so many fragments: each, cut by the others' planes, falls into at most 1 + k + k (k - 1) / 2
/// pieces, k = n - 1.
bool within_fragment_bound(const OrderBuildStats& stats);

/// All ways give the order of the full traversal after each step. Its items are steps.
Outcome ways_agree(const OrderTree& tree, const std::vector<Eye>& eyes, const Context& context);

/// How far the line where the plane of `node` cuts the one of `face` is from where rational numbers have it, wherever
/// it crosses the picture. In units of 2^-15 pixel, which is the bound.
Outcome cut_line_is_exact(const Camera& camera, const std::array<glm::dvec3, 3>& face,
                          const std::array<glm::dvec3, 3>& node, int width, int height, const Context& context = {});

}  // namespace kage::verif
