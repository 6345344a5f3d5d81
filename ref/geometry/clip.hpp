// SPDX-License-Identifier: Apache-2.0
//
// Clipping against the near plane, the far plane and the guard band. A new vertex is computed from the end inside to
// the end outside, whichever polygon of the edge asks, so neighbours get the very same one and no crack opens.
#pragma once

#include <vector>

#include "geometry/view.hpp"

namespace kage {

/// An edge on the near plane that clipping made, in the polygon's direction.
struct NearCut {
  ClipPoint from;
  ClipPoint to;
};

/// Clips one polygon after another; keeps its buffers.
class Clipper {
 public:
  /// `sub_bits`: Look::sub_bits.
  Clipper(double near, double far, int sub_bits) : near_(near), far_(far), sub_bits_(sub_bits) {}

  /// Clip in place. Near cuts are appended to `cuts` if given, even where nothing of the polygon is left. `at_far`: cut
  /// what lies past the far plane too. The outcome may be empty.
  void clip(std::vector<ClipPoint>& polygon, std::vector<NearCut>* cuts, bool at_far);

  /// Whether clipping leaves this vertex alone.
  [[nodiscard]] bool keeps(const ClipPoint& p) const;

  /// Appends the pieces of a near cut to `edges` as snapped edges, in reverse direction: the section closes what the
  /// polygons leave open. In y they are cut as the polygon is. In x pieces outside the guard band are only moved onto
  /// its border, so that pieces left of the screen still count. `w`: their weight.
  void snap_cut(const NearCut& cut, std::int32_t w, std::vector<NearEdge>& edges) const;

 private:
  double near_;
  double far_;
  int sub_bits_;
  std::vector<ClipPoint> buffer_;
};

}  // namespace kage
