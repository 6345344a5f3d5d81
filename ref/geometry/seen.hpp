// SPDX-License-Identifier: Apache-2.0
//
// The parts of a frame's faces that the picture shows, and the range of distances that depth has to cover for them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/view.hpp"
#include "kage/geometry.hpp"

namespace kage {

/// The frame's vertices, seen from its camera.
std::vector<EyePoint> eye_points(const SceneFrame& frame);

/// Cuts polygons at the picture's own edges. Keeps its buffers.
class PictureCut {
 public:
  PictureCut(const Camera& camera, int width, int height);

  /// Corners, in eye space, of the part of a polygon that lies in the picture at distance `least` or further. Empty if
  /// there is none. `points`: the points that `outline` has the numbers of.
  std::span<const EyePoint> of(std::span<const std::uint32_t> outline, std::span<const EyePoint> points, double least);

 private:
  template <class Inside>
  void cut(Inside inside);

  bool perspective_;
  double slope_x_;  // half the picture's width and height: per distance (perspective) or as they are
  double slope_y_;
  std::vector<EyePoint> corners_;
  std::vector<EyePoint> buffer_;
};

/// Whether a polygon of the frame is a drawn face. A face is not drawn if Look::cull leaves it out. Where translucent
/// faces are blended, one that blends nothing is not drawn either: with alpha 0, or seen exactly edge-on.
bool is_drawn(const SceneFrame& frame, const Config& config, const Look& look, std::uint32_t polygon);

/// The distances that the frame's depth goes over (docs/numbers.md, "Depth"). `points`: the frame's, by eye_points().
///
/// `near` is w0. It depends on d, the least distance of the drawn faces in the picture. With perspective w0 is the
/// greatest power of two that is no more than d. In parallel view it is d rounded down to a multiple of a power of two:
/// the greatest that is no more than r, the way from d to the furthest vertex. In both, w0 is at least the camera's
/// near plane, and the near plane itself if the picture shows nothing or Look::depth_from_near is set. Before all this
/// d is made 2^-20 d (parallel: 2^-20 r) less than it is computed, which is more than all roundings on the way.
DepthRange depth_range(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
                       std::span<const EyePoint> points);

/// The largest distance of the drawn faces in the picture, found as w0 is; 0 if the picture shows nothing.
double furthest_seen(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
                     std::span<const EyePoint> points);

}  // namespace kage
