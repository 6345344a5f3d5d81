// SPDX-License-Identifier: Apache-2.0
//
// Scenes by whose light a picture is judged: white bodies on a white floor, and the lights that an approximation gets
// wrong first. For tests and benchmarks.
#pragma once

#include <string>
#include <vector>

#include "kage/geometry.hpp"
#include "kage/scene.hpp"

namespace kage::verif {

/// A scene, and what is hard in it.
struct LitScene {
  std::string name;   ///< "three-lamps"
  std::string about;  ///< in a few words
  SceneParts parts;
};

/// A point light that falls off with the square of the distance, without a range; `color` is that at distance 1.
Light lamp(const glm::dvec3& position, const glm::dvec3& color);

/// One light, several of a kind, cones, ranges, a window before a table, eight lamps of an office, and a floor of two
/// triangles. The same on every machine.
std::vector<LitScene> lit_scenes();

/// Two blocks on a table, and a window beside it whose middle is `height` above the table's top. Below 1 a part of the
/// window is behind the table's face: its lower edge is at height - 1.
LitScene table_and_window(double height);

/// The points of each light that kage casts shadows from.
std::vector<std::vector<LightPoint>> sampled_points(const SceneFrame& frame, const Look& look);

}  // namespace kage::verif
