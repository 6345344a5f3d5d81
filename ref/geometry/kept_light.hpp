// SPDX-License-Identifier: Apache-2.0
//
// Faces that some light may be kept from: where a share of it matters.
#pragma once

#include <span>
#include <vector>

#include "kage/scene.hpp"
#include "scene/space.hpp"

namespace kage {

/// Whether casters may stand between faces and lights, by boxes: rather yes than no. Refers to the frame.
class KeptLight {
 public:
  explicit KeptLight(const SceneFrame& frame);

  /// Whether some component may keep light from a face. It may not be told where there are too many of both: then it
  /// may.
  /// @param polygon of the frame
  /// @param part its component
  /// @param eye_side 1: of its outside, -1: of its inside
  [[nodiscard]] bool may_be(std::uint32_t polygon, const Component& part, int eye_side, const Light& light) const;

 private:
  const SceneFrame* frame_;
  std::vector<SpaceBox> boxes_;  // of components
  bool all_;
};

}  // namespace kage
