// SPDX-License-Identifier: Apache-2.0
//
// What drawn faces and volumes have in common on their way to the screen: snapped outlines and depth planes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/clip.hpp"
#include "geometry/plane.hpp"
#include "geometry/view.hpp"

namespace kage {

/// Drawn polygons of a face: consecutive in FrameGeometry::polygons. Smooth colour may need several.
struct DrawnRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// Refers to what it is made of.
class ScreenFaces {
 public:
  ScreenFaces(const View& view, const Clipper& clipper, FrameGeometry& out)
      : view_(&view), clipper_(&clipper), out_(&out) {}

  /// Append the polygon with this outline, snapped.
  void add(ScreenPolygon p, const std::vector<ClipPoint>& outline);

  [[nodiscard]] DepthVertex depth_vertex(const ClipPoint& p) const {
    return {snap(p), to_fixed(view_->depth(p.w), kVertexFrac)};
  }

  /// The plane of a drawn face, which is `clipped` after clipping. A triangle's goes through its snapped vertices if
  /// they are all there. More vertices than three do not lie in one plane once they are snapped: theirs is the
  /// unsnapped one, by three of the points.
  [[nodiscard]] ScreenPlane face_plane(std::size_t corners, const std::array<EyePoint, 3>& t,
                                       const std::vector<ClipPoint>& clipped) const;

  /// The plane of three points of a polygon, which is `clipped` after clipping. A plane too steep is one seen edge-on:
  /// within half a subpixel every depth of the polygon is in reach, and the mean of its vertices' is taken.
  [[nodiscard]] ScreenPlane unsnapped_plane(const EyePoint& a, const EyePoint& b, const EyePoint& c,
                                            const std::vector<ClipPoint>& clipped) const;

 private:
  const View* view_;
  const Clipper* clipper_;
  FrameGeometry* out_;
};

}  // namespace kage
