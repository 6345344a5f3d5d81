// SPDX-License-Identifier: Apache-2.0
#include "geometry/view.hpp"

#include <algorithm>
#include <cmath>

namespace kage {

View::View(const Camera& camera, int width, int height, int z_bits, const DepthRange& depth, int sub_bits)
    : camera_(camera),
      near_(depth.near),
      far_(depth.far),
      half_w_(width / 2.0),
      half_h_(height / 2.0),
      per_pixel_x_(camera.half_height / half_h_),
      per_pixel_y_(camera.half_height / half_h_),
      range_(static_cast<double>((std::int64_t{1} << z_bits) - 3)),
      z_scale_(range_ / (far_ - near_) * (camera.perspective ? near_ * far_ : 1.0)),
      max_slope_(static_cast<double>(std::int64_t{1} << (z_bits + sub_bits))),
      sub_bits_(sub_bits) {}

ClipPoint View::to_clip(const EyePoint& p) const {
  const double q = camera_.perspective ? p.z : 1.0;
  return {p.x / per_pixel_x_ + half_w_ * q, half_h_ * q - p.y / per_pixel_y_, q, p.z, {0, 0, 0}};
}

glm::dvec3 View::place(const ClipPoint& p) const {
  const glm::dvec3 at = on_picture(p.sx / p.q, p.sy / p.q);
  return camera_.eye + camera_.right * (at.x * p.q) + camera_.up * (at.y * p.q) + camera_.forward * p.w;
}

std::array<glm::dvec3, 4> View::near_corners() const {
  const double scale = camera_.perspective ? near_ : 1.0;
  const glm::dvec3 centre = camera_.eye + camera_.forward * near_;
  const glm::dvec3 across = camera_.right * (half_w_ * per_pixel_x_ * scale);
  const glm::dvec3 along = camera_.up * (half_h_ * per_pixel_y_ * scale);
  return {centre - across - along, centre + across - along, centre - across + along, centre + across + along};
}

// Perspective: what is 0 at 1/near and the whole range at 1/far, linear in 1/w. So written, nothing cancels however
// close the ends lie together, and no end is passed by a rounding.
double View::depth(double w) const {
  const double linear = range_ * ((w - near_) / (far_ - near_));
  return 1.0 + (camera_.perspective ? linear * (far_ / w) : linear);
}

std::optional<ScreenPlane> View::depth_plane(const glm::dvec3& normal, const EyePoint& point,
                                             const ClipPoint& anchor) const {
  // Perspective: p = w (ex, ey, 1) with ex, ey linear on the screen, so normal . p = d gives 1/w = normal . (ex, ey, 1)
  // / d. Parallel: w = (d - nx x - ny y) / nz.
  const double denominator = camera_.perspective ? glm::dot(normal, point) : normal.z;
  const double scale = -z_scale_ / denominator;
  const double slope_x = scale * normal.x * per_pixel_x_;
  const double slope_y = -scale * normal.y * per_pixel_y_;
  // Written so that an infinity or a NaN (the plane through the eye, no area at all) is too steep as well.
  if (!(std::abs(slope_x) <= max_slope_ && std::abs(slope_y) <= max_slope_)) return std::nullopt;
  const double x = anchor.sx / anchor.q;
  const double y = anchor.sy / anchor.q;
  ScreenPlane p;
  p.x0 = static_cast<std::int32_t>(std::floor(x));
  p.y0 = static_cast<std::int32_t>(std::floor(y));
  p.a = to_fixed(slope_x, kPlaneFrac);
  p.b = to_fixed(slope_y, kPlaneFrac);
  p.c = to_fixed(depth(anchor.w) + slope_x * (p.x0 + 0.5 - x) + slope_y * (p.y0 + 0.5 - y), kPlaneFrac);
  return p;
}

CutLine View::line(const glm::dvec3& l) const {
  const double a = l.x * per_pixel_x_;
  const double b = -l.y * per_pixel_y_;
  const double c = l.z + a * (0.5 - half_w_) + b * (0.5 - half_h_);
  const double scale = std::max(std::abs(a), std::abs(b)) * 0x1p-30;
  // Parallel to the picture, or nothing but rounding: everything lies on one side.
  if (!(scale > 0) || !std::isfinite(scale)) return {0, 0, c < 0 ? -1 : 0};
  const double limit = 0x1p58;
  return {to_fixed(a / scale, 0), to_fixed(b / scale, 0), to_fixed(std::clamp(c / scale, -limit, limit), 0)};
}

bool View::is_fine(const glm::dvec3& l, const glm::dvec3& error) const {
  const double x = half_w_ * per_pixel_x_;  // no pixel is farther from the middle
  const double y = half_h_ * per_pixel_y_;
  const double off = error.x * x + error.y * y + error.z;
  // Moved along one axis of the picture by a pixel, l changes by so much.
  const double slope = std::max(std::abs(l.x) * per_pixel_x_, std::abs(l.y) * per_pixel_y_);
  // Where the true line goes, the computed l is at most `off`, and 0 within off / slope pixels from there.
  if (off <= 0x1p-16 * slope) return true;
  return std::abs(l.z) - off > std::abs(l.x) * x + std::abs(l.y) * y;  // neither line crosses the picture
}

ScreenPlane View::flat_plane(double value) { return {0, 0, to_fixed(value, kPlaneFrac), 0, 0}; }

std::int64_t to_fixed(double v, int frac) {
  return static_cast<std::int64_t>(std::floor(v * static_cast<double>(std::int64_t{1} << frac) + 0.5));
}

// The guard band ends at a whole pixel, so that a position within it is not rounded past it.
ScreenVertex snap(const ClipPoint& p, int sub_bits) {
  const double steps = 1 << sub_bits;  // of a pixel
  const std::int32_t step = 1 << (8 - sub_bits);
  return {static_cast<std::int32_t>(std::floor(p.sx / p.q * steps + 0.5)) * step,
          static_cast<std::int32_t>(std::floor(p.sy / p.q * steps + 0.5)) * step};
}

}  // namespace kage
