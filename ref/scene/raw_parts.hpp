// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kage/scene.hpp"
#include "raw.hpp"

namespace kage::scene {

/// A program's own scene, in the form that importers hand over, and its cameras and lights frame by frame, where they
/// are more than one.
struct RawParts {
  RawScene scene;
  std::vector<RawCamera> cameras;
  std::vector<std::vector<RawLight>> lights;
};

/// Throws Error, with the scene's name, where the parts are no scene: indices of nothing, numbers that are not finite
/// or out of their range, lists of a wrong length.
RawParts raw_parts(const SceneParts& parts);

}  // namespace kage::scene
