// SPDX-License-Identifier: Apache-2.0
//
// What of a frame's faces the picture shows, and the distances that depth has to go over for it.
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

  /// What of a polygon lies in the picture and from distance `least` on: its corners, in eye space. Empty if nothing
  /// does. `points`: what `outline` names.
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

/// Whether a polygon of the frame is a drawn face: Look::cull does not leave it out, and it is not a translucent one
/// that blends nothing, of alpha 0 or (where translucent faces are blended) seen exactly edge-on.
bool is_drawn(const SceneFrame& frame, const Config& config, const Look& look, std::uint32_t polygon);

/// The distances that the frame's depth goes over (docs/numbers.md, "Depth"). `points`: the frame's, by eye_points().
///
/// `near` is w0. With perspective it is the greatest power of two that is no more than the least distance of the drawn
/// faces in the picture; in parallel view that distance rounded down to a multiple of the greatest power of two that is
/// no more than what lies between it and the furthest vertex. In both it is at least the camera's near plane, and the
/// near plane itself if the picture shows nothing or Look::depth_from_near is set. The distance is taken as 2^-20 of it
/// (parallel: of what lies between) nearer than it is computed, which is more than all roundings on the way.
DepthRange depth_range(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
                       std::span<const EyePoint> points);

/// The largest distance of the drawn faces in the picture, found as w0 is; 0 if the picture shows nothing.
double furthest_seen(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
                     std::span<const EyePoint> points);

}  // namespace kage
