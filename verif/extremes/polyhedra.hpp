// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 31 - 34: polyhedra by segments and the compare tree, against the same polyhedra by spans.
#pragma once

#include "extremes/scene_case.hpp"

namespace kage::verif {

/// Family 31: a body in a view in which a unit is a pixel, its edges at chosen subpixels, and its side beside it.
struct BlockCase {
  int left = 30, top = 20;          ///< in pixels
  int left_part = 0, top_part = 0;  ///< and 1/256 pixel
  int width = 2560, height = 2560;  ///< in 1/256 pixel
  int side = 0;                     ///< of a face that leads to its back, in pixels
  bool turned = false;              ///< else edges lie on lines
  TurnCase turn;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 32: a body at what a table of faces, a buffer of segments and a segment hold.
struct CapacityCase {
  int face_bits = 3, seg_bits = 5, dx_bits = 9;
  int width = 96;
  double wide = 1;
  SolidCase solid;
  ViewCase view;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 33: any polyhedra, some of them several times.
struct UnitsCase {
  int copies = 0;  ///< of the first one, in other colours
  SceneCase scene;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 34: more polyhedra than units or indices, beside or before each other.
struct ManyCase {
  int count = 9;
  int order_bits = 8;
  double apart_x = 0, apart_y = 0, apart_z = -0.2;  ///< from one to the next
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_polyhedra_families(Families& to);

}  // namespace kage::verif
