// SPDX-License-Identifier: Apache-2.0
//
// From world space to the screen: the camera, depth, and the snap.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <optional>

#include "kage/geometry.hpp"

namespace kage {

/// A point seen from the camera: x to the right, y up, w forward, all from the eye.
using EyePoint = glm::dvec3;

/// A point before the division: screen position (sx / q, sy / q) in pixels, y down. q is the distance w (perspective)
/// or 1 (parallel).
struct ClipPoint {
  double sx = 0;
  double sy = 0;
  double q = 1;
  double w = 0;
  glm::dvec3 color{0, 0, 0};  ///< as displayed, 0 .. 255
};

class View {
 public:
  /// `far`: distance of the furthest thing to draw, > the camera's near. The camera's own far is not used: nothing
  /// drawn is cut there.
  /// `sub_bits`: Look::sub_bits.
  View(const Camera& camera, int width, int height, int z_bits, double far, int sub_bits = kMostSubBits);

  [[nodiscard]] EyePoint to_eye(const glm::dvec3& world) const;
  [[nodiscard]] ClipPoint to_clip(const EyePoint& p) const;
  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] int sub_bits() const { return sub_bits_; }

  /// The picture's corners on the near plane, in world space: everything seen lies between them and a surface.
  [[nodiscard]] std::array<glm::dvec3, 4> near_corners() const;

  /// Where volumes are cut: a little past everything drawn. Depth there still fits a span's accumulator.
  [[nodiscard]] double volume_end() const { return far_ + 0.01 * (far_ - near_); }

  /// Depth at distance w, in LSB.
  [[nodiscard]] double depth(double w) const;

  /// Steps of depth from distance w > 0 on to infinity; perspective.
  [[nodiscard]] double steps_beyond(double w) const { return z_scale_ / w; }

  /// The depth plane of the plane through `normal` and `point`, both in eye space, anchored at `anchor`, a point of it
  /// before the camera. Empty if it is too steep: more than 2^(Z_BITS + sub_bits) LSB a pixel.
  [[nodiscard]] std::optional<ScreenPlane> depth_plane(const glm::dvec3& normal, const EyePoint& point,
                                                       const ClipPoint& anchor) const;

  /// The line where l . (ex, ey, 1) = 0, (ex, ey) being a pixel's place in eye space at w = 1 (perspective) or anywhere
  /// (parallel), each coefficient rounded to nearest. Scaled so that the larger of a and b is 2^30: over a picture of
  /// 2^15 pixels it is off by less than 2^-16 of one.
  [[nodiscard]] CutLine line(const glm::dvec3& l) const;

  /// Whether numbers of `l` that are off by `error` at most leave line(l) within 2^-16 of a pixel of where it belongs,
  /// wherever it crosses the picture. No if `error` holds a NaN.
  [[nodiscard]] bool is_fine(const glm::dvec3& l, const glm::dvec3& error) const;

  /// A plane of constant depth.
  [[nodiscard]] static ScreenPlane flat_plane(double value);

 private:
  Camera camera_;
  double near_;
  double far_;
  double half_w_;  // of the picture, pixels
  double half_h_;
  double per_pixel_x_;  // eye x per pixel at w = 1 (perspective) or everywhere (parallel)
  double per_pixel_y_;
  double range_;   // LSB from near to far
  double z_base_;  // perspective: depth = z_base - z_scale / w; parallel: z_base + z_scale w
  double z_scale_;
  double max_slope_;
  int sub_bits_;
};

/// To where depth reaches: a little past the frame's furthest vertex. Nothing is cut at the far end.
double furthest(const SceneFrame& frame);

/// v * 2^frac, rounded half up. |v| 2^frac must be below 2^62.
std::int64_t to_fixed(double v, int frac);

/// Screen position, rounded half up to 2^-sub_bits pixel.
ScreenVertex snap(const ClipPoint& p, int sub_bits);

}  // namespace kage
