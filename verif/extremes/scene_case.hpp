// SPDX-License-Identifier: Apache-2.0
//
// Scenes of a few solids as cases: all that they are made of is a field.
#pragma once

#include "extremes/family.hpp"
#include "kage/geometry.hpp"
#include "stimulus/shapes.hpp"

namespace kage::verif {

/// A rotation by a quaternion 1 + a i + b j + c k; all 0: none.
struct TurnCase {
  double a = 0, b = 0, c = 0;
  void fields(Fields& f);
  [[nodiscard]] Turn turn() const;
};

/// A box, tetrahedron or octahedron.
struct SolidCase {
  int kind = 0;
  double x = 0, y = 0, z = 0;           ///< its middle
  double wide = 1, high = 1, deep = 1;  ///< half of its sizes
  TurnCase turn;
  void fields(Fields& f);
  [[nodiscard]] Solid solid() const;
  /// Adds it as a component of its own, in a colour that follows from `index`.
  void add_to(SceneFrame& frame, std::size_t index, bool convex = true) const;
};

/// Where the eye is and how it looks.
struct ViewCase {
  double x = 0, y = 0, z = 4;  ///< eye
  double at_x = 0, at_y = 0, at_z = 0;
  bool parallel = false;
  double half_height = 0.5;
  double near = 0.1;
  void fields(Fields& f);
  void apply_to(Camera& camera) const;
};

/// One light that casts hard shadows.
struct LampCase {
  bool placed = false;         ///< a point, else at infinity
  double x = 0, y = 4, z = 0;  ///< where it is, or where it comes from
  void fields(Fields& f);
  void apply_to(Light& light) const;
};

/// The bits of a subpixel that positions have, and how geometry is made with them.
void sub_bits_field(Fields& f, int& sub_bits);
Look look_of(int sub_bits);

/// Solids strewn about the origin, on a floor or not.
struct SceneCase {
  bool floor = true;
  bool convex = true;  ///< what components say of themselves
  std::vector<SolidCase> solids;
  ViewCase view;
  LampCase lamp;
  int sub_bits = kMostSubBits;
  void fields(Fields& f) { fields(f, 1, 8); }
  void fields(Fields& f, std::size_t least, std::size_t most);
  [[nodiscard]] SceneFrame frame() const;
  [[nodiscard]] Look look() const { return look_of(sub_bits); }
};

}  // namespace kage::verif
