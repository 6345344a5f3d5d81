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

/// The point seen from the camera.
inline EyePoint to_eye(const Camera& camera, const glm::dvec3& world) {
  const glm::dvec3 d = world - camera.eye;
  return {glm::dot(d, camera.right), glm::dot(d, camera.up), glm::dot(d, camera.forward)};
}

/// The distances that stored depth goes over, 0 < near < far.
struct DepthRange {
  double near = 1;  ///< w0
  double far = 2;   ///< of the furthest thing to draw, or beyond
};

class View {
 public:
  /// `depth`: of the frame. The camera's own far is not used: nothing drawn is cut there. `sub_bits`: Look::sub_bits.
  View(const Camera& camera, int width, int height, int z_bits, const DepthRange& depth, int sub_bits = kMostSubBits);

  [[nodiscard]] EyePoint to_eye(const glm::dvec3& world) const { return kage::to_eye(camera_, world); }
  [[nodiscard]] ClipPoint to_clip(const EyePoint& p) const;

  /// The place of a point before the division, in world space: to_clip() backwards. q must not be 0.
  [[nodiscard]] glm::dvec3 place(const ClipPoint& p) const;

  /// The point of the picture at (x, y), in pixels, as line() has it.
  [[nodiscard]] glm::dvec3 on_picture(double x, double y) const {
    return {(x - half_w_) * per_pixel_x_, (half_h_ - y) * per_pixel_y_, 1};
  }

  /// w0, where depth begins and faces and volumes are cut: nothing that is seen lies nearer.
  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] bool perspective() const { return camera_.perspective; }
  [[nodiscard]] int sub_bits() const { return sub_bits_; }

  /// The picture's corners at w0, in world space: everything seen lies between them and a surface.
  [[nodiscard]] std::array<glm::dvec3, 4> near_corners() const;

  /// Where volumes are cut: a little past everything drawn. Depth there still fits a span's accumulator.
  [[nodiscard]] double volume_end() const { return far_ + 0.01 * (far_ - near_); }

  /// Depth at distance w, in LSB: 1 at w0 and 2^Z_BITS - 2 at the far end, to the bit.
  [[nodiscard]] double depth(double w) const;

  /// How far apart two surfaces at distance w > 0 are whose depths differ by an LSB.
  [[nodiscard]] double step(double w) const { return camera_.perspective ? w / z_scale_ * w : 1 / z_scale_; }

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
  double range_;    // LSB from near to far
  double z_scale_;  // what depth falls by per 1/w (perspective) or rises by per w (parallel)
  double max_slope_;
  int sub_bits_;
};

/// v * 2^frac, rounded half up. |v| 2^frac must be below 2^62.
std::int64_t to_fixed(double v, int frac);

/// Screen position, rounded half up to 2^-sub_bits pixel.
ScreenVertex snap(const ClipPoint& p, int sub_bits);

}  // namespace kage
