// SPDX-License-Identifier: Apache-2.0
#include "geometry/face_drawer.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "geometry/fan.hpp"

namespace kage {

FramePoints::FramePoints(std::vector<EyePoint> seen, const ScreenFaces& faces) : eye(std::move(seen)) {
  screen.reserve(eye.size());
  for (const EyePoint& e : eye) screen.push_back(faces.screen_point(e));
}

FaceDrawer::FaceDrawer(const SceneFrame& frame, std::vector<EyePoint> points, const Config& config, const View& view,
                       Clipper& clipper, const FaceShading& shading, int max_shading, FrameGeometry& out)
    : frame_(&frame),
      config_(&config),
      clipper_(&clipper),
      shading_(&shading),
      out_(&out),
      faces_(view, clipper, out),
      dicer_(view, faces_, shading, max_shading, out),
      points_(std::move(points), faces_),
      drawn_(frame.polygons.size()) {}

void FaceDrawer::draw_unseen(std::uint32_t index) {
  diced_ = false;
  draw(index);
  diced_ = true;
}

FaceDrawer::Mark FaceDrawer::mark() const {
  return {out_->polygons.size(), out_->vertices.size(), out_->color_planes.size(), out_->shade_cuts.size(),
          out_->shades.size()};
}

void FaceDrawer::undo_to(const Mark& m) {
  out_->polygons.resize(m.polygons);
  out_->vertices.resize(m.vertices);
  out_->color_planes.resize(m.color_planes);
  out_->shade_cuts.resize(m.shade_cuts);
  out_->shades.resize(m.shades);
}

void FaceDrawer::draw(std::uint32_t index) {
  const Polygon& face = frame_->polygons[index];
  const auto corners = frame_->outline(face);
  const Triangle& t = frame_->triangles[face.triangle];
  polygon_.clear();
  snapped_.clear();
  bool whole = true;
  for (const std::uint32_t corner : corners) {
    const ScreenPoint& at = points_.screen[corner];
    polygon_.push_back(at.clip);
    snapped_.push_back(at.vertex.at);
    whole = whole && at.kept;
  }
  const FaceShading::Shaded shaded = shading_->shade(index, polygon_);

  drawn_[index].first = static_cast<std::uint32_t>(out_->polygons.size());
  if (!whole) clipper_->clip(polygon_, nullptr, false);
  if (polygon_.empty()) return;
  ScreenPolygon base;
  base.lit = shaded.lit;
  base.normal_class = shaded.normal_class;
  base.alpha = config_->translucency > 0 ? t.alpha : std::uint8_t{255};
  base.source = index;
  base.depth = depth_plane(corners, t, whole);
  for (std::size_t c = 0; c < 3; ++c)
    base.color[c] = static_cast<std::uint8_t>(to_fixed(std::clamp(shaded.mean[static_cast<int>(c)], 0.0, 255.0), 0));
  const bool alike = (shaded.linear ? has_one_light(shaded) : shaded.same_color) && is_linear(shaded);
  if (shaded.linear && alike && diced_)
    base.light_planes =
        static_cast<std::int32_t>(dicer_.add_light(shading_->light_at(shaded, shaded.surface.corner(0).point)));
  if (config_->smooth != 0 && !alike)
    add_fan(base, shaded);
  else if (whole)
    faces_.add(base, snapped_);
  else
    faces_.add(base, polygon_);
  drawn_[index].count = static_cast<std::uint32_t>(out_->polygons.size()) - drawn_[index].first;
}

void FaceDrawer::undo(std::uint32_t index) {
  out_->vertices.resize(out_->polygons.back().first_vertex);
  out_->polygons.pop_back();
  drawn_[index].count = 0;
}

// Whether all corners of a face have the same linear light.
bool FaceDrawer::has_one_light(const FaceShading::Shaded& shaded) const {
  if (!shaded.varies) return true;
  const FaceShading::Light first = shading_->light_at(shaded, shaded.surface.corner(0).point);
  for (std::size_t i = 1; i < shaded.surface.corners(); ++i)
    if (shading_->light_at(shaded, shaded.surface.corner(i).point) != first) return false;
  return true;
}

// Whether one colour serves all of a face whose corners have one.
bool FaceDrawer::is_linear(const FaceShading::Shaded& shaded) {
  if (!diced_) return true;
  for (std::size_t i = 1; i + 1 < polygon_.size(); ++i)
    if (dicer_.differs(shaded, {polygon_[0], polygon_[i], polygon_[i + 1]})) return false;
  return true;
}

// Colour is linear on the screen within a triangle, so a clipped triangle becomes a fan; all its pieces keep one depth
// plane. The snap may bend an outline so far that every fan of it has overlaps. Such an outline is drawn whole, with
// the colours of its largest triangle: it is only a few steps of the snap wide, and drawing each pixel once matters
// more than its colours.
void FaceDrawer::add_fan(const ScreenPolygon& base, const FaceShading::Shaded& shaded) {
  const std::size_t n = polygon_.size();
  faces_.snap_outline(polygon_, snapped_);
  const auto add_piece = [&](std::size_t apex, std::size_t i, bool whole) {
    ScreenPolygon piece = base;
    std::vector<ClipPoint> triangle{polygon_[apex], polygon_[(apex + i) % n], polygon_[(apex + i + 1) % n]};
    if (!whole && diced_) piece.shade_cut = dicer_.dice(shaded, std::span<ClipPoint, 3>(triangle), piece.normal_class);
    piece.color_planes = static_cast<std::int32_t>(out_->color_planes.size());
    if (shaded.linear)
      piece.light_planes = static_cast<std::int32_t>(dicer_.add_light(shaded, std::span<ClipPoint, 3>(triangle)));
    else
      for (int c = 0; c < 3; ++c) out_->color_planes.push_back(faces_.color_plane(triangle, c));
    if (whole)
      faces_.add(piece, snapped_);
    else
      faces_.add(piece, std::array{snapped_[apex], snapped_[(apex + i) % n], snapped_[(apex + i + 1) % n]});
  };
  if (const auto apex = fan_corner(snapped_)) {
    for (std::size_t i = 1; i + 1 < n; ++i) add_piece(*apex, i, false);
    return;
  }
  const auto area = [&](std::size_t i) { return std::abs(twice_area(snapped_[0], snapped_[i], snapped_[i + 1])); };
  std::size_t largest = 1;
  for (std::size_t i = 2; i + 1 < n; ++i)
    if (area(i) > area(largest)) largest = i;
  add_piece(0, largest, true);
}

// The plane of a drawn face, which is in polygon_ after clipping. A triangle's goes through its snapped vertices if it
// is whole. More vertices than three do not lie in one plane once they are snapped: theirs is the unsnapped one, by the
// triangle that the face has its plane of. Three corners are the face's own, even where it was put together from more
// triangles.
ScreenPlane FaceDrawer::depth_plane(std::span<const std::uint32_t> corners, const Triangle& t, bool whole) const {
  if (corners.size() == 3 && whole)
    if (const auto plane = plane_through(
            {points_.screen[corners[0]].vertex, points_.screen[corners[1]].vertex, points_.screen[corners[2]].vertex}))
      return *plane;
  const auto own = corners.size() == 3 ? corners : std::span<const std::uint32_t>(t.vertex);
  return faces_.unsnapped_plane(points_.eye[own[0]], points_.eye[own[1]], points_.eye[own[2]], polygon_);
}

}  // namespace kage
