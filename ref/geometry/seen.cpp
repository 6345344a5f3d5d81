// SPDX-License-Identifier: Apache-2.0
#include "geometry/seen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/facing.hpp"
#include "geometry/translucent.hpp"

namespace kage {
namespace {

// Share by which the nearest distance is taken nearer than computed. It is 2^32 times the rounding of a double, so that
// no rounding can cut a face at w0, however far its vertices lie outside the picture.
constexpr double kNearer = 0x1p-20;
// The far end lies this share past the furthest vertex, so that depth is finite where all lies at one distance.
constexpr double kFurther = 1e-6;

// The greatest power of two that is at most v > 0.
double power_below(double v) {
  int exponent = 0;
  (void)std::frexp(v, &exponent);
  return std::ldexp(1.0, exponent - 1);
}

// Where depth begins if `nearest` is what is seen nearest.
double begin_of(const Camera& camera, double nearest, double far) {
  const double reach = camera.perspective ? nearest : far - nearest;
  const double least = nearest - kNearer * reach;
  const double unit = power_below(camera.perspective ? least : reach);
  const double begin = camera.perspective ? unit : std::floor(least / unit) * unit;
  return std::max(camera.near, begin);
}

}  // namespace

std::vector<EyePoint> eye_points(const SceneFrame& frame) {
  std::vector<EyePoint> points;
  points.reserve(frame.vertices.size());
  for (const glm::dvec3& p : frame.vertices) points.push_back(to_eye(frame.camera, p));
  return points;
}

PictureCut::PictureCut(const Camera& camera, int width, int height)
    : perspective_(camera.perspective), slope_x_(camera.half_height * width / height), slope_y_(camera.half_height) {}

// Keep what of corners_ has inside() >= 0.
template <class Inside>
void PictureCut::cut(Inside inside) {
  buffer_.clear();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const EyePoint& a = corners_[i];
    const EyePoint& b = corners_[i + 1 == corners_.size() ? 0 : i + 1];
    const double da = inside(a);
    const double db = inside(b);
    if (da >= 0) buffer_.push_back(a);
    if ((da >= 0) != (db >= 0)) buffer_.push_back(a + da / (da - db) * (b - a));
  }
  corners_.swap(buffer_);
}

std::span<const EyePoint> PictureCut::of(std::span<const std::uint32_t> outline, std::span<const EyePoint> points,
                                         double least) {
  corners_.clear();
  for (const std::uint32_t v : outline) corners_.push_back(points[v]);
  const auto across = [this](const EyePoint& p) { return perspective_ ? p.z : 1.0; };
  cut([&](const EyePoint& p) { return p.z - least; });
  cut([&](const EyePoint& p) { return slope_x_ * across(p) - p.x; });
  cut([&](const EyePoint& p) { return slope_x_ * across(p) + p.x; });
  cut([&](const EyePoint& p) { return slope_y_ * across(p) - p.y; });
  cut([&](const EyePoint& p) { return slope_y_ * across(p) + p.y; });
  return corners_;
}

bool is_drawn(const SceneFrame& frame, const Config& config, const Look& look, std::uint32_t polygon) {
  const Triangle& t = frame.triangles[frame.polygons[polygon].triangle];
  const bool blended = config.translucency > 0 && t.alpha < 255;
  if (blended && t.alpha == 0) return false;
  if (!blended && !look.cull) return true;
  const double facing =
      blended ? eye_side(frame.camera, triangle_of(frame, polygon)) : facing_of(frame, t, normal_of(frame, t));
  return !(blended && facing == 0) && !is_culled(frame, look, polygon, facing);
}

// Only polygons with a vertex nearer than what would change w0 are cut.
DepthRange depth_range(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
                       std::span<const EyePoint> points) {
  const Camera& camera = frame.camera;
  double far = 0;
  for (const EyePoint& p : points) far = std::max(far, p.z);
  far *= 1 + kFurther;
  DepthRange range{camera.near, std::max(far, camera.near * (1 + kFurther))};
  if (look.depth_from_near || far <= camera.near) return range;
  PictureCut picture(camera, width, height);
  double nearest = std::numeric_limits<double>::infinity();
  double limit = nearest;  // what is not nearer than this leaves w0 where it is
  for (std::uint32_t i = 0; i < frame.polygons.size(); ++i) {
    const auto outline = frame.outline(frame.polygons[i]);
    if (std::none_of(outline.begin(), outline.end(), [&](std::uint32_t v) { return points[v].z < limit; })) continue;
    double least = nearest;
    for (const EyePoint& corner : picture.of(outline, points, camera.near)) least = std::min(least, corner.z);
    if (!(least < limit) || !is_drawn(frame, config, look, i)) continue;
    nearest = least;
    range.near = begin_of(camera, nearest, far);
    if (range.near == camera.near) break;
    limit = camera.perspective ? range.near * (1 + 2 * kNearer) : nearest;
  }
  return range;
}

double furthest_seen(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
                     std::span<const EyePoint> points) {
  PictureCut picture(frame.camera, width, height);
  double most = 0;
  for (std::uint32_t i = 0; i < frame.polygons.size(); ++i) {
    const auto outline = frame.outline(frame.polygons[i]);
    if (std::none_of(outline.begin(), outline.end(), [&](std::uint32_t v) { return points[v].z > most; })) continue;
    double furthest = most;
    for (const EyePoint& corner : picture.of(outline, points, std::max(most, frame.camera.near)))
      furthest = std::max(furthest, corner.z);
    if (furthest > most && is_drawn(frame, config, look, i)) most = furthest;
  }
  return most;
}

}  // namespace kage
