// SPDX-License-Identifier: Apache-2.0
#include "geometry/screen_faces.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace kage {

ScreenPoint ScreenFaces::screen_point(const EyePoint& e) const {
  ScreenPoint p;
  p.clip = view_->to_clip(e);
  p.kept = clipper_->keeps(p.clip);
  if (p.kept) p.vertex = depth_vertex(p.clip);
  return p;
}

void ScreenFaces::add(const ScreenPolygon& p, std::span<const ScreenVertex> outline) {
  ScreenPolygon& added = out_->polygons.emplace_back(p);
  added.first_vertex = static_cast<std::uint32_t>(out_->vertices.size());
  added.vertex_count = static_cast<std::uint32_t>(outline.size());
  out_->vertices.insert(out_->vertices.end(), outline.begin(), outline.end());
}

void ScreenFaces::add(const ScreenPolygon& p, const std::vector<ClipPoint>& outline) {
  snap_outline(outline, snapped_);
  add(p, snapped_);
}

void ScreenFaces::snap_outline(const std::vector<ClipPoint>& outline, std::vector<ScreenVertex>& snapped) const {
  snapped.clear();
  for (const ClipPoint& c : outline) snapped.push_back(snap(c, view_->sub_bits()));
}

ScreenPlane ScreenFaces::unsnapped_plane(const EyePoint& a, const EyePoint& b, const EyePoint& c,
                                         const std::vector<ClipPoint>& clipped) const {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  if (const auto plane = view_->depth_plane(normal, a, clipped[0])) return *plane;
  double sum = 0;
  for (const ClipPoint& p : clipped) sum += view_->depth(p.w);
  return View::flat_plane(sum / static_cast<double>(clipped.size()));
}

ScreenPlane ScreenFaces::color_plane(const std::vector<ClipPoint>& p, int channel) const {
  std::array<double, 3> x{};
  std::array<double, 3> y{};
  std::array<double, 3> v{};
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = p[i].sx / p[i].q;
    y[i] = p[i].sy / p[i].q;
    v[i] = p[i].color[channel];
  }
  const double dx1 = x[1] - x[0];
  const double dy1 = y[1] - y[0];
  const double dx2 = x[2] - x[0];
  const double dy2 = y[2] - y[0];
  const double area = dx1 * dy2 - dx2 * dy1;
  const double a = ((v[1] - v[0]) * dy2 - (v[2] - v[0]) * dy1) / area;
  const double b = ((v[2] - v[0]) * dx1 - (v[1] - v[0]) * dx2) / area;
  const double max_slope = 256.0 * (1 << view_->sub_bits());  // all of the range within a step of the snap
  if (!(std::abs(a) <= max_slope && std::abs(b) <= max_slope)) return View::flat_plane((v[0] + v[1] + v[2]) / 3.0);
  ScreenPlane plane;
  plane.x0 = static_cast<std::int32_t>(std::floor(x[0]));
  plane.y0 = static_cast<std::int32_t>(std::floor(y[0]));
  plane.a = to_fixed(a, kPlaneFrac);
  plane.b = to_fixed(b, kPlaneFrac);
  plane.c = to_fixed(v[0] + a * (plane.x0 + 0.5 - x[0]) + b * (plane.y0 + 0.5 - y[0]), kPlaneFrac);
  return plane;
}

}  // namespace kage
