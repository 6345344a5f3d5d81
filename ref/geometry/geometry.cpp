// SPDX-License-Identifier: Apache-2.0
#include "kage/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <tuple>

#include "geometry/clip.hpp"
#include "geometry/plane.hpp"
#include "geometry/shade.hpp"
#include "geometry/shadow_volume.hpp"
#include "geometry/translucent.hpp"
#include "geometry/view.hpp"
#include "kage/error.hpp"
#include "number/int128.hpp"

namespace kage {
namespace {

// Drawn polygons of a face: consecutive in FrameGeometry::polygons. Smooth colour may need several.
struct DrawnRange {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

class Builder {
 public:
  Builder(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
          TranslucentOrder& order)
      : frame_(&frame),
        order_(&order),
        config_(&config),
        look_(&look),
        view_(frame.camera, width, height, config.z_bits, furthest(frame)),
        caster_(frame, view_.near_corners(), look.extrusion),
        light_(frame.light, frame.camera.up),
        clipper_(view_.near(), view_.volume_end()) {
    out_.width = width;
    out_.height = height;
    for (unsigned c = 0; c < 3; ++c) out_.background |= static_cast<std::uint32_t>(look.background[c]) << (8 * c);
    if (config.channels == 1) out_.background = look.background[1];
    out_.shade = static_cast<std::uint32_t>(to_fixed(look.darkening, config.shade_frac));
  }

  FrameGeometry build() {
    eye_points_.reserve(frame_->vertices.size());
    for (const glm::dvec3& p : frame_->vertices) eye_points_.push_back(view_.to_eye(p));
    drawn_.resize(frame_->polygons.size());
    draw_all();
    out_.drawn = static_cast<std::uint32_t>(out_.polygons.size());
    // What is turned away may still be a cap.
    if (config_->dsf_bits > 0)
      for (const std::uint32_t i : turned_away_) draw(i);
    if (config_->dsf_bits > 0) caster_.each([this](const WorldVolume& v) { add_volume(v); });
    if (config_->translucency > 0) draw_translucent();
    return std::move(out_);
  }

 private:
  // Depth reaches from the near plane to the furthest vertex; nothing is cut at the far end.
  static double furthest(const SceneFrame& frame) {
    double far = 0;
    for (const glm::dvec3& p : frame.vertices)
      far = std::max(far, glm::dot(p - frame.camera.eye, frame.camera.forward));
    return std::max(far * (1 + 1e-6), frame.camera.near * (1 + 1e-3));
  }

  // Polyhedra first, then the rest, each in the scene's order: whether a polyhedron goes to a unit or becomes spans
  // changes no tie.
  void draw_all() {
    for (std::uint32_t c = 0; c < frame_->components.size(); ++c) out_.span_reasons.push_back(draw_polyhedron(c));
    for (std::uint32_t c = 0; c < frame_->components.size(); ++c)
      if (out_.span_reasons[c] != SpanReason::none && !frame_->components[c].translucent) draw_component(c);
    if (config_->translucency > 0) return;
    for (std::uint32_t c = 0; c < frame_->components.size(); ++c)
      if (frame_->components[c].translucent) draw_component(c);
  }

  void draw_component(std::uint32_t component) {
    const Component& part = frame_->components[component];
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) draw(i);
  }

  // Faces that the eye sees edge-on cover nothing, whatever the snap makes of them; nor do those of alpha 0.
  void draw_translucent() {
    std::vector<std::uint32_t> faces;
    for (const Component& part : frame_->components)
      for (std::uint32_t i = part.first_polygon; part.translucent && i < part.first_polygon + part.polygon_count; ++i)
        if (frame_->triangles[frame_->polygons[i].triangle].alpha > 0) faces.push_back(i);
    if (faces.empty()) return;
    std::vector<int> sides;
    sides.reserve(faces.size());
    for (const std::uint32_t i : faces) {
      sides.push_back(eye_side(frame_->camera, triangle_of(*frame_, i)));
      if (sides.back() != 0) draw(i);
    }
    FragmentMaker(*frame_, view_, order_->data(), faces, sides)
        .make(
            look_->translucent,
            [this](std::uint32_t face) { return std::pair(drawn_[face].first, drawn_[face].count); }, out_);
  }

  // Nothing is drawn unless the component is a polyhedron.
  SpanReason draw_polyhedron(std::uint32_t component) {
    const Component& part = frame_->components[component];
    if (part.translucent) return SpanReason::translucent;
    if (!part.closed) return SpanReason::not_closed;
    if (!part.convex) return SpanReason::not_convex;
    const auto faces = std::span(frame_->polygons).subspan(part.first_polygon, part.polygon_count);
    for (const Polygon& face : faces)
      for (const std::uint32_t v : frame_->outline(face))
        if (!clipper_.keeps(view_.to_clip(eye_points_[v]))) return SpanReason::cut;

    const std::size_t polygons = out_.polygons.size();
    const std::size_t vertices = out_.vertices.size();
    const std::size_t turned_away = turned_away_.size();
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
      draw(i);
      if (out_.polygons.back().color_planes >= 0) {
        out_.color_planes.resize(static_cast<std::size_t>(out_.polygons[drawn_[i].first].color_planes));
        out_.polygons.resize(polygons);
        out_.vertices.resize(vertices);
        turned_away_.resize(turned_away);
        return SpanReason::colors;
      }
      if (is_turned_away(out_.outline(out_.polygons.back()))) {
        out_.vertices.resize(out_.polygons.back().first_vertex);
        out_.polygons.pop_back();
        drawn_[i].count = 0;
        turned_away_.push_back(i);
      }
    }
    Polyhedron p;
    p.component = component;
    p.first_polygon = static_cast<std::uint32_t>(polygons);
    p.polygon_count = static_cast<std::uint32_t>(out_.polygons.size() - polygons);
    p.first_edge = static_cast<std::uint32_t>(out_.polyhedron_edges.size());
    add_edges(part);
    p.edge_count = static_cast<std::uint32_t>(out_.polyhedron_edges.size()) - p.first_edge;
    out_.polyhedra.push_back(p);
    return SpanReason::none;
  }

  // Each edge once, from its lower vertex to its higher one.
  void add_edges(const Component& part) {
    struct Side {
      std::uint32_t low;
      std::uint32_t high;
      bool along;
      std::uint32_t polygon;
    };
    std::vector<Side> sides;
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
      const auto corners = frame_->outline(frame_->polygons[i]);
      const std::uint32_t polygon = drawn_[i].count == 0 ? PolyhedronEdge::kNoPolygon : drawn_[i].first;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const std::uint32_t a = corners[k];
        const std::uint32_t b = corners[(k + 1) % corners.size()];
        sides.push_back({std::min(a, b), std::max(a, b), a < b, polygon});
      }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
      return std::tie(p.low, p.high, p.along) < std::tie(q.low, q.high, q.along);
    });
    // Closed: sides come in pairs, one each way.
    for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
      const Side& against = sides[i];
      const Side& along = sides[i + 1];
      if (along.polygon == PolyhedronEdge::kNoPolygon && against.polygon == PolyhedronEdge::kNoPolygon) continue;
      out_.polyhedron_edges.push_back({snap(view_.to_clip(eye_points_[along.low])),
                                       snap(view_.to_clip(eye_points_[along.high])), along.polygon, against.polygon});
    }
  }

  // Counter-clockwise from outside is clockwise with y down, when seen from the front: a positive area is the back.
  static bool is_turned_away(std::span<const ScreenVertex> outline) {
    Int128 area = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const ScreenVertex& a = outline[i];
      const ScreenVertex& b = outline[(i + 1) % outline.size()];
      area += Int128{a.x} * b.y - Int128{b.x} * a.y;
    }
    return area > 0;
  }

  void draw(std::uint32_t index) {
    const Polygon& face = frame_->polygons[index];
    const auto corners = frame_->outline(face);
    const Triangle& t = frame_->triangles[face.triangle];
    const glm::dvec3& p = frame_->vertices[t.vertex[0]];
    const glm::dvec3 normal = glm::cross(frame_->vertices[t.vertex[1]] - p, frame_->vertices[t.vertex[2]] - p);
    const Camera& camera = frame_->camera;
    const double facing = camera.perspective ? glm::dot(normal, camera.eye - p) : -glm::dot(normal, camera.forward);
    const int light_side = caster_.facing(face);
    const bool lit = (facing > 0 && light_side > 0) || (facing < 0 && light_side < 0);

    polygon_.clear();
    glm::dvec3 mean{0, 0, 0};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      polygon_.push_back(view_.to_clip(eye_points_[corners[i]]));
      // More corners than a triangle's share one look.
      const ShadingVertex& s = frame_->shading[t.shading[corners.size() == 3 ? i : 0]];
      const glm::dvec3 towards_eye = facing < 0 ? -s.normal : s.normal;
      polygon_.back().color =
          light_.displayed(frame_->vertices[corners[i]], towards_eye, s.color, lit, config_->channels == 1);
      mean += polygon_.back().color;
    }
    const bool same_color =
        std::all_of(polygon_.begin(), polygon_.end(), [&](const ClipPoint& c) { return c.color == polygon_[0].color; });
    mean = same_color ? polygon_[0].color : mean / static_cast<double>(polygon_.size());

    drawn_[index].first = static_cast<std::uint32_t>(out_.polygons.size());
    clipper_.clip(polygon_, nullptr, false);
    if (polygon_.empty()) return;
    ScreenPolygon base;
    base.lit = lit;
    base.alpha = config_->translucency > 0 ? t.alpha : std::uint8_t{255};
    base.source = index;
    // Three corners are the face's own, even where it was put together from more triangles.
    base.depth = corners.size() == 3
                     ? face_plane(3, {eye_points_[corners[0]], eye_points_[corners[1]], eye_points_[corners[2]]})
                     : face_plane(corners.size(),
                                  {eye_points_[t.vertex[0]], eye_points_[t.vertex[1]], eye_points_[t.vertex[2]]});
    for (std::size_t c = 0; c < 3; ++c)
      base.color[c] = static_cast<std::uint8_t>(to_fixed(std::clamp(mean[static_cast<int>(c)], 0.0, 255.0), 0));
    if (config_->smooth == 0 || same_color) {
      add_outline(base, polygon_);
    } else {
      // Colour is linear on the screen within a triangle, so a clipped triangle becomes a fan; all its pieces keep one
      // depth plane.
      for (std::size_t i = 1; i + 1 < polygon_.size(); ++i) {
        piece_.assign({polygon_[0], polygon_[i], polygon_[i + 1]});
        ScreenPolygon piece = base;
        piece.color_planes = static_cast<std::int32_t>(out_.color_planes.size());
        for (int c = 0; c < 3; ++c) out_.color_planes.push_back(color_plane(piece_, c));
        add_outline(piece, piece_);
      }
    }
    drawn_[index].count = static_cast<std::uint32_t>(out_.polygons.size()) - drawn_[index].first;
  }

  void add_volume(const WorldVolume& w) {
    ShadowVolume v;
    v.first_face = static_cast<std::uint32_t>(out_.volume_faces.size());
    v.first_near = static_cast<std::uint32_t>(out_.near_edges.size());
    v.component = w.component;
    for (const CapFace& cap : w.caps) {
      const DrawnRange& range = drawn_[cap.polygon];
      for (std::uint32_t i = 0; i < range.count; ++i)
        out_.volume_faces.push_back({range.first + i, cap.turned ? -1 : 1});
      points_.clear();
      for (const std::uint32_t c : frame_->outline(frame_->polygons[cap.polygon])) points_.push_back(eye_points_[c]);
      if (cap.turned) std::reverse(points_.begin(), points_.end());
      cut_only();
    }
    for (const SideFace& s : w.sides) add_side(s);
    for (const auto& f : w.far_end) {
      points_.clear();
      for (const glm::dvec3& p : f) points_.push_back(view_.to_eye(p));
      if (look_->far_ends)
        add_face([&] { return unsnapped_plane(points_[0], points_[1], points_[2]); });
      else
        cut_only();
    }
    v.face_count = static_cast<std::uint32_t>(out_.volume_faces.size()) - v.first_face;
    v.near_count = static_cast<std::uint32_t>(out_.near_edges.size()) - v.first_near;
    if (v.face_count + v.near_count > 0) out_.volumes.push_back(v);
  }

  void add_side(const SideFace& s) {
    points_.assign({view_.to_eye(s.a), view_.to_eye(s.far_a), view_.to_eye(s.far_b), view_.to_eye(s.b)});
    add_face([&] { return side_plane(drawn_[s.polygon], points_[0], points_[3], points_[1]); });
  }

  // A face of a volume that is not drawn: the polygon in points_, with the plane that make_plane() gives once it is
  // clipped.
  template <class MakePlane>
  void add_face(MakePlane make_plane) {
    polygon_.clear();
    for (const EyePoint& e : points_) polygon_.push_back(view_.to_clip(e));
    clip_and_cut();
    if (polygon_.empty()) return;
    ScreenPolygon face;
    face.source = ~0U;
    face.depth = make_plane();
    out_.volume_faces.push_back({static_cast<std::uint32_t>(out_.polygons.size()), 1});
    add_outline(face, polygon_);
  }

  // Only the section with the near plane of the polygon in points_, which is never a span, or is one already.
  void cut_only() {
    const bool crosses =
        std::any_of(points_.begin(), points_.end(), [this](const EyePoint& e) { return e.z < view_.near(); });
    if (!crosses) return;
    polygon_.clear();
    for (const EyePoint& e : points_) polygon_.push_back(view_.to_clip(e));
    clip_and_cut();
  }

  void clip_and_cut() {
    cuts_.clear();
    clipper_.clip(polygon_, &cuts_, !look_->far_ends);
    for (const NearCut& cut : cuts_) clipper_.snap_cut(cut, out_.near_edges);
  }

  void add_outline(ScreenPolygon p, const std::vector<ClipPoint>& points) {
    p.first_vertex = static_cast<std::uint32_t>(out_.vertices.size());
    p.vertex_count = static_cast<std::uint32_t>(points.size());
    for (const ClipPoint& c : points) out_.vertices.push_back(snap(c));
    out_.polygons.push_back(p);
  }

  [[nodiscard]] DepthVertex depth_vertex(const ClipPoint& p) const {
    return {snap(p), to_fixed(view_.depth(p.w), kVertexFrac)};
  }

  // The plane of a drawn face, in polygon_ after clipping. A triangle's goes through its snapped vertices if they are
  // all there. More vertices than three do not lie in one plane once they are snapped: theirs is the unsnapped one, by
  // three of the points.
  ScreenPlane face_plane(std::size_t corners, const std::array<EyePoint, 3>& t) const {
    if (corners == 3) {
      const std::array<ClipPoint, 3> p{view_.to_clip(t[0]), view_.to_clip(t[1]), view_.to_clip(t[2])};
      if (clipper_.keeps(p[0]) && clipper_.keeps(p[1]) && clipper_.keeps(p[2]))
        if (const auto plane = plane_through({depth_vertex(p[0]), depth_vertex(p[1]), depth_vertex(p[2])}))
          return *plane;
    }
    return unsnapped_plane(t[0], t[1], t[2]);
  }

  static std::int64_t slope(const ScreenPlane& p) { return std::abs(p.a) + std::abs(p.b); }

  // The plane of a volume's side, in polygon_ after clipping: through the snapped edge that it shares with its cap and
  // the vertex furthest from it. On the edge it has the depths that the cap has there, so that it leaves the cap
  // exactly at their common edge. But a cap steeper than the side is further off its own corners there than the side's
  // slope allows for, and would move the side's shadow far away: then the side has the corners' depths.
  ScreenPlane side_plane(const DrawnRange& cap, const EyePoint& a, const EyePoint& b, const EyePoint& c) const {
    const ClipPoint pa = view_.to_clip(a);
    const ClipPoint pb = view_.to_clip(b);
    if (cap.count > 0 && clipper_.keeps(pa) && clipper_.keeps(pb)) {
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
      const auto plane = plane_through({depth_vertex(pa), depth_vertex(pb), depth_vertex(*furthest)});
      const ScreenPlane& at = out_.polygons[cap.first].depth;
      if (plane && slope(at) <= slope(*plane))
        if (const auto joined = plane_through({on_plane(at, sa), on_plane(at, sb), depth_vertex(*furthest)}))
          return *joined;
      if (plane) return *plane;
    }
    return unsnapped_plane(a, b, c);
  }

  // The plane of three points of a polygon that is in polygon_, clipped. A plane too steep is one seen edge-on: within
  // half a subpixel every depth of the polygon is in reach, and the mean of its vertices' is taken.
  ScreenPlane unsnapped_plane(const EyePoint& a, const EyePoint& b, const EyePoint& c) const {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    if (const auto plane = view_.depth_plane(normal, a, polygon_[0])) return *plane;
    double sum = 0;
    for (const ClipPoint& p : polygon_) sum += view_.depth(p.w);
    return View::flat_plane(sum / static_cast<double>(polygon_.size()));
  }

  static ScreenPlane color_plane(const std::vector<ClipPoint>& p, int channel) {
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
    constexpr double kMaxSlope = 65536.0;  // all of the range within 1/256 pixel
    if (!(std::abs(a) <= kMaxSlope && std::abs(b) <= kMaxSlope)) return View::flat_plane((v[0] + v[1] + v[2]) / 3.0);
    ScreenPlane plane;
    plane.x0 = static_cast<std::int32_t>(std::floor(x[0]));
    plane.y0 = static_cast<std::int32_t>(std::floor(y[0]));
    plane.a = to_fixed(a, kPlaneFrac);
    plane.b = to_fixed(b, kPlaneFrac);
    plane.c = to_fixed(v[0] + a * (plane.x0 + 0.5 - x[0]) + b * (plane.y0 + 0.5 - y[0]), kPlaneFrac);
    return plane;
  }

  const SceneFrame* frame_;
  TranslucentOrder* order_;
  const Config* config_;
  const Look* look_;
  View view_;
  ShadowCaster caster_;
  LightView light_;
  Clipper clipper_;
  FrameGeometry out_;
  std::vector<EyePoint> eye_points_;
  std::vector<DrawnRange> drawn_;
  std::vector<std::uint32_t> turned_away_;  // polygons of polyhedra, into SceneFrame::polygons
  std::vector<EyePoint> points_;
  std::vector<ClipPoint> polygon_;
  std::vector<ClipPoint> piece_;
  std::vector<NearCut> cuts_;
};

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_finite(const SceneFrame& frame) {
  for (std::size_t i = 0; i < frame.vertices.size(); ++i)
    if (!finite(frame.vertices[i])) throw Error(fmt::format("vertex {}: position is not finite", i));
  const Camera& c = frame.camera;
  if (!finite(c.eye) || !finite(c.right) || !finite(c.up) || !finite(c.forward) || !(c.near > 0) ||
      !std::isfinite(c.near) || !(c.half_height > 0) || !std::isfinite(c.half_height))
    throw Error("the camera is not finite, or its near plane or field of view is not positive");
  const Light& l = frame.light;
  if (!finite(l.directional ? l.direction : l.position)) throw Error("the light is not finite");
}

}  // namespace

FrameGeometry make_geometry(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
                            TranslucentOrder* order) {
  if (width < 1 || height < 1 || width > kMaxSize || height > kMaxSize)
    throw Error(fmt::format("size {}x{}: width and height must be 1 .. {}", width, height, kMaxSize));
  if (frame.polygons.empty()) throw Error("the scene has no faces");
  check_finite(frame);
  TranslucentOrder fresh;
  return Builder(frame, config, width, height, look, order != nullptr ? *order : fresh).build();
}

}  // namespace kage
