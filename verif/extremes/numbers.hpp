// SPDX-License-Identifier: Apache-2.0
//
// Cases of family 10, numbers that are none or very large or small, and the sRGB curve.
#pragma once

#include "extremes/scene_case.hpp"

namespace kage::verif {

/// An octahedron over a plate, all its numbers sound.
SceneFrame plain_scene();

/// Family 10: one number of a scene is not finite.
struct NotFiniteCase {
  int value = 0;
  int place = 0;
  int index = 0;  ///< of the vertex
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 10: a scene scaled by a power of ten, and one coordinate that is next to nothing.
struct ScaledCase {
  int exponent = 0;
  bool denormal = false;
  SceneCase scene;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// The sRGB curve by square roots.
struct CurveCase {
  double linear = 0;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_number_families(Families& to);

}  // namespace kage::verif
