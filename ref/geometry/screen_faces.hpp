// SPDX-License-Identifier: Apache-2.0
//
// Snapped outlines and depth planes, which drawn faces and volumes share on their way to the screen.
#pragma once

#include <cstdint>
#include <span>
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

/// A vertex of the frame on the screen: the same for every face that has it.
struct ScreenPoint {
  ClipPoint clip;
  bool kept = false;   ///< by clipping
  DepthVertex vertex;  ///< if it is kept
};

/// Refers to what it is made of.
class ScreenFaces {
 public:
  ScreenFaces(const View& view, const Clipper& clipper, FrameGeometry& out)
      : view_(&view), clipper_(&clipper), out_(&out) {}

  [[nodiscard]] ScreenPoint screen_point(const EyePoint& e) const;

  /// Append the polygon with this outline, snapped or to be snapped.
  void add(const ScreenPolygon& p, std::span<const ScreenVertex> outline);
  void add(const ScreenPolygon& p, const std::vector<ClipPoint>& outline);

  /// The outline with its corners snapped, in `snapped`.
  void snap_outline(const std::vector<ClipPoint>& outline, std::vector<ScreenVertex>& snapped) const;

  [[nodiscard]] DepthVertex depth_vertex(const ClipPoint& p) const {
    return {snap(p, view_->sub_bits()), to_fixed(view_->depth(p.w), kVertexFrac)};
  }

  /// The plane of three points of a polygon, which is `clipped` after clipping. A plane too steep is one seen edge-on:
  /// within half a subpixel every depth of the polygon is in reach, and the mean of its vertices' is taken.
  [[nodiscard]] ScreenPlane unsnapped_plane(const EyePoint& a, const EyePoint& b, const EyePoint& c,
                                            const std::vector<ClipPoint>& clipped) const;

  /// The plane of a colour channel of a clipped triangle, in units of an 8-bit colour. One too steep is the mean of its
  /// vertices' all over.
  [[nodiscard]] ScreenPlane color_plane(const std::vector<ClipPoint>& p, int channel) const;

 private:
  const View* view_;
  const Clipper* clipper_;
  FrameGeometry* out_;
  std::vector<ScreenVertex> snapped_;
};

}  // namespace kage
