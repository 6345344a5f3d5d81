// SPDX-License-Identifier: Apache-2.0
// Convex bodies on the screen: visible faces, and edges with the faces on both sides. [Ohno 1985]
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/face_drawer.hpp"

namespace kage {

/// Refers to what it is made of.
class PolyhedronDrawer {
 public:
  PolyhedronDrawer(const SceneFrame& frame, const Look& look, FaceDrawer& drawer, FrameGeometry& out)
      : frame_(&frame), look_(&look), drawer_(&drawer), out_(&out) {}

  /// Nothing is drawn unless the component is a polyhedron, of which the eye sees the outside. Its faces that are
  /// turned away are appended to `turned_away`.
  SpanReason draw(std::uint32_t component, std::vector<std::uint32_t>& turned_away);

 private:
  [[nodiscard]] SpanReason reason_of(const Component& part) const;
  void add_edges(const Component& part);

  const SceneFrame* frame_;
  const Look* look_;
  FaceDrawer* drawer_;
  FrameGeometry* out_;
};

}  // namespace kage
