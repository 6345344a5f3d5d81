// SPDX-License-Identifier: Apache-2.0
#include "geometry/volume_maker.hpp"

#include <algorithm>
#include <cstdlib>

#include "number/int128.hpp"

namespace kage {
namespace {

std::int64_t slope(const ScreenPlane& p) { return std::abs(p.a) + std::abs(p.b); }

// Twice the signed area between an edge and the vertex furthest from it, of `count` that `at` gives, and which it is.
struct Furthest {
  std::size_t vertex = 0;
  std::int64_t area = 0;
};

template <class At>
Furthest furthest_from(const ScreenVertex& a, const ScreenVertex& b, std::size_t count, At at) {
  Furthest f;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t area = double_area(a, b, at(i));
    if (std::abs(area) > std::abs(f.area)) f = {i, area};
  }
  return f;
}

// Whether a plane has a vertex's depth, to `bound`.
bool is_on(const ScreenPlane& plane, const DepthVertex& v, std::int64_t bound) {
  return std::abs(on_plane(plane, v.at).z - v.z) <= bound;
}

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
  if (!clip_face(s.w)) return;
  const ScreenPlane truth = faces_.unsnapped_plane(points_[0], points_[3], points_[1], polygon_);
  if (start_at_cap(drawn_[s.polygon], slope(truth)))
    add_joined(s.w, truth, out_->outline(out_->polygons[drawn_[s.polygon].first]));
  else
    add_polygon(s.w, truth, polygon_);
}

void VolumeMaker::add_far_end(const CapFace& cap) {
  points_.clear();
  for (const std::uint32_t c : frame_->outline(frame_->polygons[cap.polygon])) points_.push_back(far_point(c));
  if (!cap.turned) std::reverse(points_.begin(), points_.end());
  if (!far_ends_)
    cut_only();
  else if (clip_face(1))
    add_polygon(1, faces_.unsnapped_plane(points_[0], points_[1], points_[2], polygon_), polygon_);
}

// Clip a face of a volume that is not drawn, from points_ to polygon_. False if nothing of it is left.
bool VolumeMaker::clip_face(std::int32_t w) {
  polygon_.clear();
  for (const EyePoint& e : points_) polygon_.push_back(view_->to_clip(e));
  clip_and_cut(w);
  return !polygon_.empty();
}

void VolumeMaker::add_polygon(std::int32_t w, const ScreenPlane& plane, const std::vector<ClipPoint>& outline) {
  ScreenPolygon face;
  face.source = ~0U;
  face.depth = plane;
  out_->volume_faces.push_back({static_cast<std::uint32_t>(out_->polygons.size()), w});
  faces_.add(face, outline);
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

// Joins a side, in polygon_ after clipping, to its cap. The side's vertices go into ring_, beginning at the edge that
// side and cap share. There they get the cap's depths, so that at this edge the side is neither before nor behind the
// cap. False where clipping has changed the edge. `side_slope`: of the side's unsnapped plane.
// With two kinds of caps the side keeps the corners' depths, which are those of a triangle's plane too. A cap steeper
// than the side is further off its own corners there than the side's slope allows for, and would move the side's
// shadow far away. A cap seen edge-on has one depth all over, the mean of its corners', which is of no use.
bool VolumeMaker::start_at_cap(const DrawnRange& cap, std::int64_t side_slope) {
  const ClipPoint pa = view_->to_clip(points_[0]);
  const ClipPoint pb = view_->to_clip(points_[3]);
  if (cap.count == 0 || !clipper_->keeps(pa) || !clipper_->keeps(pb)) return false;
  const auto first = std::find_if(polygon_.begin(), polygon_.end(), [&](const ClipPoint& p) {
    return p.sx == pa.sx && p.sy == pa.sy && p.q == pa.q && p.w == pa.w;
  });
  std::rotate(polygon_.begin(), first, polygon_.end());
  ring_.clear();
  for (const ClipPoint& p : polygon_) ring_.push_back(faces_.depth_vertex(p));
  const ScreenPlane& at = out_->polygons[cap.first].depth;
  if (slope(at) <= side_slope && !is_edge_on(at, ring_.front().at, pa) && !is_edge_on(at, ring_.back().at, pb)) {
    ring_.front() = on_plane(at, ring_.front().at);
    ring_.back() = on_plane(at, ring_.back().at);
  }
  return true;
}

// The plane through the side's first edge that has the depths of all other vertices, to `bound`: the one through the
// vertex furthest from it if it does, else one that shares the errors out. Empty if there is none.
std::optional<ScreenPlane> VolumeMaker::whole_plane(std::int64_t bound) const {
  const auto [furthest, most] = furthest_from(ring_.front().at, ring_.back().at, ring_.size(),
                                              [&](std::size_t i) -> const ScreenVertex& { return ring_[i].at; });
  if (most == 0) return std::nullopt;
  DepthVertex third = ring_[furthest];
  auto plane = plane_through({ring_.front(), ring_.back(), third});
  if (!plane) return std::nullopt;
  const std::span<const DepthVertex> others = std::span(ring_).subspan(1, ring_.size() - 2);
  const auto all_on = [&] {
    return std::all_of(others.begin(), others.end(), [&](const DepthVertex& v) { return is_on(*plane, v, bound); });
  };
  if (all_on()) return plane;
  // Where the furthest vertex moves by d, another's error changes by d times its share of the largest area.
  Int128 least = -bound;
  Int128 greatest = bound;
  for (const DepthVertex& v : others) {
    const Int128 error = on_plane(*plane, v.at).z - v.z;
    const std::int64_t area = double_area(ring_.front().at, ring_.back().at, v.at);
    const std::int64_t share = most < 0 ? -area : area;
    if (share <= 0) continue;
    least = std::max(least, (-bound - error) * std::abs(most) / share);
    greatest = std::min(greatest, (bound - error) * std::abs(most) / share);
  }
  if (least > greatest) return std::nullopt;
  third.z += static_cast<std::int64_t>((least + greatest) / 2);
  plane = plane_through({ring_.front(), ring_.back(), third});
  return plane && all_on() ? plane : std::nullopt;
}

// Adds the side in ring_. It has up to seven vertices and a plane goes through three: half a subpixel at a short edge
// grows with the distance from it. Where that shows, a side that lies beyond the edge cannot hide its cap, and has its
// unsnapped plane. Any other side is parted into pieces, all with the first vertex; each has the plane of its own
// vertices, and only vertices that lie on it. Neighbours meet on the line that they share.
void VolumeMaker::add_joined(std::int32_t w, const ScreenPlane& truth, std::span<const ScreenVertex> cap) {
  const std::int64_t bound =
      ((slope(truth) >> (view_->sub_bits() + 1)) >> (kPlaneFrac - kVertexFrac)) + (std::int64_t{1} << kVertexFrac);
  if (const auto whole = whole_plane(bound)) return add_polygon(w, *whole, polygon_);
  const ScreenVertex& a = ring_.front().at;
  const ScreenVertex& b = ring_.back().at;
  const auto of_cap = furthest_from(a, b, cap.size(), [&](std::size_t i) { return cap[i]; });
  const auto of_side = furthest_from(a, b, ring_.size(), [&](std::size_t i) { return ring_[i].at; });
  if ((of_cap.area < 0) != (of_side.area < 0)) return add_polygon(w, truth, polygon_);
  for (std::size_t last = ring_.size() - 1; last > 1;) {
    std::size_t next = last - 1;
    const auto plane = plane_through({ring_[0], ring_[last], ring_[next]});
    while (plane && next > 1 && is_on(*plane, ring_[next - 1], bound)) --next;
    piece_.assign(polygon_.begin() + static_cast<std::ptrdiff_t>(next),
                  polygon_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    piece_.push_back(polygon_[0]);
    add_polygon(w, plane ? *plane : truth, piece_);
    last = next;
  }
}

}  // namespace kage
