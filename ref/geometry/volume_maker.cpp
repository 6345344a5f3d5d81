// SPDX-License-Identifier: Apache-2.0
#include "geometry/volume_maker.hpp"

#include <algorithm>
#include <cstdlib>

namespace kage {
namespace {

std::int64_t slope(const ScreenPlane& p) { return std::abs(p.a) + std::abs(p.b); }

}  // namespace

void VolumeMaker::add(const WorldVolume& w, const ShadowCaster& caster, std::uint32_t sample, std::uint32_t component,
                      const std::vector<bool>& casts) {
  const auto wanted = [&](std::uint32_t polygon) { return casts[component_of_[polygon]]; };
  caster_ = &caster;
  factor_ = caster.far_factor(w.caps);
  ShadowVolume v;
  v.first_face = static_cast<std::uint32_t>(out_->volume_faces.size());
  v.first_near = static_cast<std::uint32_t>(out_->near_edges.size());
  v.component = component;
  v.sample = sample;
  for (const CapFace& cap : w.caps)
    if (wanted(cap.polygon)) add_cap(cap);
  for (const SideEdge& s : w.sides)
    if (wanted(s.polygon)) add_side(s);
  for (const CapFace& cap : w.caps)
    if (wanted(cap.polygon)) add_far_end(cap);
  v.face_count = static_cast<std::uint32_t>(out_->volume_faces.size()) - v.first_face;
  v.near_count = static_cast<std::uint32_t>(out_->near_edges.size()) - v.first_near;
  if (v.face_count + v.near_count > 0) out_->volumes.push_back(v);
}

EyePoint VolumeMaker::far_point(std::uint32_t vertex) const {
  return view_->to_eye(caster_->far_point(frame_->vertices[vertex], factor_));
}

void VolumeMaker::add_cap(const CapFace& cap) {
  const DrawnRange& range = drawn_[cap.polygon];
  for (std::uint32_t i = 0; i < range.count; ++i) out_->volume_faces.push_back({range.first + i, cap.turned ? -1 : 1});
  points_.clear();
  for (const std::uint32_t c : frame_->outline(frame_->polygons[cap.polygon])) points_.push_back(eye_points_[c]);
  if (cap.turned) std::reverse(points_.begin(), points_.end());
  cut_only();
}

void VolumeMaker::add_side(const SideEdge& s) {
  points_.assign({eye_points_[s.a], far_point(s.a), far_point(s.b), eye_points_[s.b]});
  add_face(s.w, [&] { return side_plane(drawn_[s.polygon], points_[0], points_[3], points_[1]); });
}

void VolumeMaker::add_far_end(const CapFace& cap) {
  points_.clear();
  for (const std::uint32_t c : frame_->outline(frame_->polygons[cap.polygon])) points_.push_back(far_point(c));
  if (!cap.turned) std::reverse(points_.begin(), points_.end());
  if (far_ends_)
    add_face(1, [&] { return faces_.unsnapped_plane(points_[0], points_[1], points_[2], polygon_); });
  else
    cut_only();
}

// A face of a volume that is not drawn: the polygon in points_, with the plane that make_plane() gives once it is
// clipped.
template <class MakePlane>
void VolumeMaker::add_face(std::int32_t w, MakePlane make_plane) {
  polygon_.clear();
  for (const EyePoint& e : points_) polygon_.push_back(view_->to_clip(e));
  clip_and_cut(w);
  if (polygon_.empty()) return;
  ScreenPolygon face;
  face.source = ~0U;
  face.depth = make_plane();
  out_->volume_faces.push_back({static_cast<std::uint32_t>(out_->polygons.size()), w});
  faces_.add(face, polygon_);
}

// Only the section with the near plane of the polygon in points_, which is never a span, or is one already.
void VolumeMaker::cut_only() {
  const bool crosses =
      std::any_of(points_.begin(), points_.end(), [this](const EyePoint& e) { return e.z < view_->near(); });
  if (!crosses) return;
  polygon_.clear();
  for (const EyePoint& e : points_) polygon_.push_back(view_->to_clip(e));
  clip_and_cut(1);
}

void VolumeMaker::clip_and_cut(std::int32_t w) {
  cuts_.clear();
  clipper_->clip(polygon_, &cuts_, !far_ends_);
  for (const NearCut& cut : cuts_) clipper_->snap_cut(cut, w, out_->near_edges);
}

// Whether the cap's plane is the stand-in of ScreenFaces::unsnapped_plane(): of one depth, where its corner's is
// another. A plane that is truly square to the view has its corners' depths to an LSB.
bool VolumeMaker::is_edge_on(const ScreenPlane& cap, const ScreenVertex& at, const ClipPoint& corner) const {
  return cap.a == 0 && cap.b == 0 &&
         std::abs(on_plane(cap, at).z - faces_.depth_vertex(corner).z) > std::int64_t{1} << kVertexFrac;
}

// The plane of a volume's side, in polygon_ after clipping: through the snapped edge that it shares with its cap and
// the vertex furthest from it. On the edge it has the depths that the cap has there, so that it leaves the cap exactly
// at their common edge. But a cap steeper than the side is further off its own corners there than the side's slope
// allows for, and would move the side's shadow far away: then the side has the corners' depths.
// A cap seen edge-on has one depth all over, the mean of its corners', and none of it is any use.
ScreenPlane VolumeMaker::side_plane(const DrawnRange& cap, const EyePoint& a, const EyePoint& b,
                                    const EyePoint& c) const {
  const ClipPoint pa = view_->to_clip(a);
  const ClipPoint pb = view_->to_clip(b);
  if (cap.count > 0 && clipper_->keeps(pa) && clipper_->keeps(pb)) {
    const ScreenVertex sa = snap(pa);
    const ScreenVertex sb = snap(pb);
    const ClipPoint* furthest = &polygon_[0];
    std::int64_t most = 0;
    for (const ClipPoint& p : polygon_) {
      const std::int64_t area = std::abs(double_area(sa, sb, snap(p)));
      if (area > most) {
        most = area;
        furthest = &p;
      }
    }
    const auto plane =
        plane_through({faces_.depth_vertex(pa), faces_.depth_vertex(pb), faces_.depth_vertex(*furthest)});
    const ScreenPlane& at = out_->polygons[cap.first].depth;
    if (plane && slope(at) <= slope(*plane) && !is_edge_on(at, sa, pa) && !is_edge_on(at, sb, pb))
      if (const auto joined = plane_through({on_plane(at, sa), on_plane(at, sb), faces_.depth_vertex(*furthest)}))
        return *joined;
    if (plane) return *plane;
  }
  return faces_.unsnapped_plane(a, b, c, polygon_);
}

}  // namespace kage
