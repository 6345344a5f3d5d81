// SPDX-License-Identifier: Apache-2.0
#include "kage/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <tuple>

#include "geometry/light_table.hpp"
#include "geometry/screen_faces.hpp"
#include "geometry/shade.hpp"
#include "geometry/translucent.hpp"
#include "geometry/volume_maker.hpp"
#include "kage/error.hpp"
#include "kage/light.hpp"
#include "number/int128.hpp"
#include "shadow/receivers.hpp"
#include "shadow/volumes.hpp"

namespace kage {
namespace {

class Builder {
 public:
  Builder(const SceneFrame& frame, const Config& config, int width, int height, const Look& look,
          TranslucentOrder& order, ShadowCache& shadows)
      : frame_(&frame),
        order_(&order),
        shadows_(&shadows),
        config_(&config),
        look_(&look),
        view_(frame.camera, width, height, config.z_bits, furthest(frame)),
        lighting_(frame.lights, frame.camera.up),
        clipper_(view_.near(), view_.volume_end()),
        faces_(view_, clipper_, out_) {
    out_.width = width;
    out_.height = height;
    for (unsigned c = 0; c < 3; ++c) out_.background |= static_cast<std::uint32_t>(look.background[c]) << (8 * c);
    if (config.channels == 1) out_.background = look.background[1];
    // Without table all lights shine, and the first casts.
    casting_ = config.dsf_bits > 0 ? std::min(frame.lights.size(), static_cast<std::size_t>(config.lights)) : 0;
    sample_lights();
    if (casting_ > 0)
      out_.shade = static_cast<std::uint32_t>(to_fixed(look.darkening / samples_of_[0], config.shade_frac));
    table_.emplace(config, look, frame.lights, lighting_, samples_of_);
  }

  FrameGeometry build() {
    eye_points_.reserve(frame_->vertices.size());
    for (const glm::dvec3& p : frame_->vertices) eye_points_.push_back(view_.to_eye(p));
    screen_points_.reserve(eye_points_.size());
    for (const EyePoint& e : eye_points_) screen_points_.push_back(faces_.screen_point(e));
    out_.polygons.reserve(frame_->polygons.size());
    out_.vertices.reserve(frame_->corners.size());
    drawn_.resize(frame_->polygons.size());
    if (table_->exists()) lit_faces_.resize(frame_->polygons.size());
    draw_all();
    out_.drawn = static_cast<std::uint32_t>(out_.polygons.size());
    if (table_->exists()) classify_drawn();
    // What is turned away may still be a cap.
    if (config_->dsf_bits > 0)
      for (const std::uint32_t i : turned_away_) draw(i);
    if (config_->dsf_bits > 0) {
      VolumeMaker maker(*frame_, view_, clipper_, eye_points_, drawn_, look_->far_ends, out_);
      const std::vector<SpaceBox> boxes = component_boxes(*frame_);
      VolumeCaster volumes(*frame_, boxes, config_->dsf_bits, look_->volumes, ShadowCacheInside::of(*shadows_));
      std::optional<Receivers> receivers;
      if (look_->leave_out) receivers.emplace(*frame_, boxes, out_.width, out_.height, config_->translucency == 0);
      std::vector<bool> casts(frame_->components.size(), true);
      for (std::uint32_t i = 0; i < sample_casters_.size(); ++i) {
        const ShadowCaster& caster = sample_casters_[i];
        if (receivers) casts = receivers->reached(caster.light());
        volumes.make(i, caster,
                     [&](const WorldVolume& v, std::uint32_t component) { maker.add(v, caster, i, component, casts); });
      }
      if (look_->fit && config_->fsf == 0) keep_first_volumes();
    }
    if (config_->translucency > 0) draw_translucent();
    table_->finish(out_);
    return std::move(out_);
  }

 private:
  // Faces and edges of those that go stay where they are: nothing names them any more.
  void keep_first_volumes() {
    const std::size_t all = out_.volumes.size();
    const auto end = std::unique(out_.volumes.begin(), out_.volumes.end(),
                                 [](const ShadowVolume& a, const ShadowVolume& b) { return a.sample == b.sample; });
    out_.volumes.erase(end, out_.volumes.end());
    out_.left_out = static_cast<std::uint32_t>(all - out_.volumes.size());
  }

  void sample_lights() {
    for (std::size_t l = 0; l < frame_->lights.size(); ++l) {
      std::vector<LightPoint> points{frame_->lights[l]};  // the middle, then the samples unless they are the middle
      if (l < casting_ && config_->count_bits > 0) {
        const bool fits = !look_->fit || look_->samples >> config_->count_bits == 0;
        const auto samples = light_points(frame_->lights[l], fits ? look_->samples : 1, look_->seed + l);
        if (samples.size() > 1) points.insert(points.end(), samples.begin(), samples.end());
        if (samples.size() >> config_->count_bits > 0)
          throw Error(
              fmt::format("{} samples of a light do not fit COUNT_BITS = {}", samples.size(), config_->count_bits));
      }
      const auto casters = ShadowCaster::of_points(*frame_, points, view_.near_corners(), look_->extrusion);
      casters_.push_back(casters[0]);
      if (l >= casting_) continue;
      const auto first = casters.begin() + (points.size() > 1 ? 1 : 0);
      sample_casters_.insert(sample_casters_.end(), first, casters.end());
      const auto samples = static_cast<std::size_t>(casters.end() - first);
      samples_of_.push_back(static_cast<int>(samples));
      out_.sample_light.insert(out_.sample_light.end(), samples, static_cast<std::uint8_t>(l));
    }
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

  // Each face that is seen has a class and weighs in it once, however many polygons it was drawn as and however often
  // it was tried. Translucent ones, drawn later, have none: TP knows no class.
  void classify_drawn() {
    std::vector<std::uint32_t> of_face(frame_->polygons.size(), 0);
    for (ScreenPolygon& p : out_.polygons) {
      if (!p.lit) continue;
      std::uint32_t& number = of_face[p.source];
      const LitFace& face = lit_faces_[p.source];
      if (number == 0) number = table_->classify(face.normal, face.middle, face.area, face.lit);
      p.normal_class = number;
    }
  }

  void draw_component(std::uint32_t component) {
    const Component& part = frame_->components[component];
    for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
      const Triangle& t = frame_->triangles[frame_->polygons[i].triangle];
      if (is_culled(i, facing_of(t, normal_of(t))))
        turned_away_.push_back(i);
      else
        draw(i);
    }
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
      if (sides.back() != 0 && !is_culled(i, sides.back())) draw(i);
    }
    FragmentMaker(*frame_, view_, TranslucentOrderInside::of(*order_), faces, sides)
        .make(
            look_->translucent,
            [this](std::uint32_t face) { return std::pair(drawn_[face].first, drawn_[face].count); }, out_);
  }

  // Nothing is drawn unless the component is a polyhedron, of which the eye sees the outside.
  SpanReason draw_polyhedron(std::uint32_t component) {
    const Component& part = frame_->components[component];
    if (part.translucent) return SpanReason::translucent;
    if (!part.closed) return SpanReason::not_closed;
    if (!part.convex) return SpanReason::not_convex;
    const auto faces = std::span(frame_->polygons).subspan(part.first_polygon, part.polygon_count);
    for (const Polygon& face : faces)
      for (const std::uint32_t v : frame_->outline(face))
        if (!screen_points_[v].kept) return SpanReason::cut;
    if (look_->cull && std::any_of(faces.begin(), faces.end(), [&](const Polygon& face) {
          return frame_->triangles[face.triangle].sides == Sides::back;
        }))
      return SpanReason::culled;

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
      out_.polyhedron_edges.push_back(
          {screen_points_[along.low].vertex.at, screen_points_[along.high].vertex.at, along.polygon, against.polygon});
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

  // Out of the face, twice its area long.
  glm::dvec3 normal_of(const Triangle& t) const {
    const glm::dvec3& p = frame_->vertices[t.vertex[0]];
    return glm::cross(frame_->vertices[t.vertex[1]] - p, frame_->vertices[t.vertex[2]] - p);
  }

  // Above 0 where the eye sees the outside of the face that has this triangle, below 0 where it sees its inside.
  double facing_of(const Triangle& t, const glm::dvec3& normal) const {
    const Camera& camera = frame_->camera;
    return camera.perspective ? glm::dot(normal, camera.eye - frame_->vertices[t.vertex[0]])
                              : -glm::dot(normal, camera.forward);
  }

  // `facing`: above 0 where the eye sees the outside, below 0 where it sees the inside.
  bool is_culled(std::uint32_t index, double facing) const {
    const Sides sides = frame_->triangles[frame_->polygons[index].triangle].sides;
    return look_->cull && ((sides == Sides::front && facing < 0) || (sides == Sides::back && facing > 0));
  }

  static bool same_side(double facing, int light_side) {
    return (facing > 0 && light_side > 0) || (facing < 0 && light_side < 0);
  }

  // Whether shadows darken the face: with a table if some light reaches it. Without, only if all samples do: where some
  // are behind it, it shadows itself, and a constant share would darken what is nearly unlit anyway, face by face.
  bool takes_shadow(double facing, const FacePlane& plane, const std::bitset<kMaxLights>& lit) const {
    if (casting_ == 0) return lit[0];
    if (table_->exists()) return (lit << (kMaxLights - casting_)).any();
    return std::all_of(sample_casters_.begin(), sample_casters_.end(),
                       [&](const ShadowCaster& c) { return same_side(facing, c.facing(plane)); });
  }

  void draw(std::uint32_t index) {
    const Polygon& face = frame_->polygons[index];
    const auto corners = frame_->outline(face);
    const Triangle& t = frame_->triangles[face.triangle];
    const glm::dvec3 normal = normal_of(t);
    const double facing = facing_of(t, normal);
    std::bitset<kMaxLights> lit;
    const FacePlane plane(*frame_, face);
    for (std::size_t l = 0; l < casters_.size(); ++l) lit[l] = same_side(facing, casters_[l].facing(plane));

    polygon_.clear();
    snapped_.clear();
    bool whole = true;
    const bool by_place = lighting_.depends_on_place(lit);
    glm::dvec3 mean{0, 0, 0};
    glm::dvec3 mean_normal{0, 0, 0};
    glm::dvec3 middle{0, 0, 0};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const ScreenPoint& at = screen_points_[corners[i]];
      polygon_.push_back(at.clip);
      snapped_.push_back(at.vertex.at);
      whole = whole && at.kept;
      // More corners than a triangle's share one look.
      const std::uint32_t look = t.shading[corners.size() == 3 ? i : 0];
      const ShadingVertex& s = frame_->shading[look];
      const glm::dvec3 towards_eye = facing < 0 ? -s.normal : s.normal;
      const bool as_before = i > 0 && !by_place && (corners.size() > 3 || look == t.shading[i - 1]);
      const bool grey = config_->channels == 1;
      polygon_.back().color = as_before ? polygon_[i - 1].color
                              : t.unlit
                                  ? Lighting::displayed_unlit(s.color, grey)
                                  : lighting_.displayed(frame_->vertices[corners[i]], towards_eye, s.color, lit, grey);
      mean += polygon_.back().color;
      mean_normal += towards_eye;
      middle += frame_->vertices[corners[i]];
    }
    const bool same_color =
        std::all_of(polygon_.begin(), polygon_.end(), [&](const ClipPoint& c) { return c.color == polygon_[0].color; });
    mean = same_color ? polygon_[0].color : mean / static_cast<double>(polygon_.size());

    drawn_[index].first = static_cast<std::uint32_t>(out_.polygons.size());
    if (!whole) clipper_.clip(polygon_, nullptr, false);
    if (polygon_.empty()) return;
    ScreenPolygon base;
    base.lit = !t.unlit && takes_shadow(facing, plane, lit);
    if (table_->exists()) {
      const double mean_length = length(mean_normal);
      lit_faces_[index] = {mean_length > 0 ? mean_normal / mean_length : mean_normal,
                           middle / static_cast<double>(corners.size()), length(normal), lit};
    }
    base.alpha = config_->translucency > 0 ? t.alpha : std::uint8_t{255};
    base.source = index;
    base.depth = depth_plane(corners, t, whole);
    for (std::size_t c = 0; c < 3; ++c)
      base.color[c] = static_cast<std::uint8_t>(to_fixed(std::clamp(mean[static_cast<int>(c)], 0.0, 255.0), 0));
    if (config_->smooth == 0 || same_color) {
      if (whole)
        faces_.add(base, snapped_);
      else
        faces_.add(base, polygon_);
    } else {
      // Colour is linear on the screen within a triangle, so a clipped triangle becomes a fan; all its pieces keep one
      // depth plane.
      for (std::size_t i = 1; i + 1 < polygon_.size(); ++i) {
        piece_.assign({polygon_[0], polygon_[i], polygon_[i + 1]});
        ScreenPolygon piece = base;
        piece.color_planes = static_cast<std::int32_t>(out_.color_planes.size());
        for (int c = 0; c < 3; ++c) out_.color_planes.push_back(ScreenFaces::color_plane(piece_, c));
        faces_.add(piece, piece_);
      }
    }
    drawn_[index].count = static_cast<std::uint32_t>(out_.polygons.size()) - drawn_[index].first;
  }

  // The plane of a drawn face, which is in polygon_ after clipping. A triangle's goes through its snapped vertices if
  // it is whole. More vertices than three do not lie in one plane once they are snapped: theirs is the unsnapped one,
  // by the triangle that the face has its plane of. Three corners are the face's own, even where it was put together
  // from more triangles.
  ScreenPlane depth_plane(std::span<const std::uint32_t> corners, const Triangle& t, bool whole) const {
    if (corners.size() == 3 && whole)
      if (const auto plane = plane_through({screen_points_[corners[0]].vertex, screen_points_[corners[1]].vertex,
                                            screen_points_[corners[2]].vertex}))
        return *plane;
    const auto own = corners.size() == 3 ? corners : std::span<const std::uint32_t>(t.vertex);
    return faces_.unsnapped_plane(eye_points_[own[0]], eye_points_[own[1]], eye_points_[own[2]], polygon_);
  }

  const SceneFrame* frame_;
  TranslucentOrder* order_;
  ShadowCache* shadows_;
  const Config* config_;
  const Look* look_;
  View view_;
  std::vector<ShadowCaster> casters_;  // of the lights' middles
  std::size_t casting_ = 0;            // so many lights, the first ones, cast shadows
  Lighting lighting_;
  std::vector<ShadowCaster> sample_casters_;  // of their samples
  std::vector<int> samples_of_;               // of each light that casts
  std::optional<LightTable> table_;
  Clipper clipper_;
  FrameGeometry out_;
  ScreenFaces faces_;
  std::vector<EyePoint> eye_points_;        // of the frame's vertices
  std::vector<ScreenPoint> screen_points_;  // likewise
  std::vector<DrawnRange> drawn_;
  // What the light table asks of a face.
  struct LitFace {
    glm::dvec3 normal;
    glm::dvec3 middle;
    double area;
    std::bitset<kMaxLights> lit;
  };
  std::vector<LitFace> lit_faces_;          // of SceneFrame::polygons, if there is a table
  std::vector<std::uint32_t> turned_away_;  // polygons of polyhedra, into SceneFrame::polygons
  // Of the face being drawn:
  std::vector<ClipPoint> polygon_;
  std::vector<ScreenVertex> snapped_;
  std::vector<ClipPoint> piece_;
};

// Of the light's distance to the scene by that's size: further off, a shadow's sides stray from where they should be by
// more than 2^-12 of the scene.
constexpr double kFurthestLight = 0x1p40;

void check_light(const Light& l, std::size_t number, const SpaceBox& scene) {
  const auto refuse = [number](const char* why) { throw Error(fmt::format("light {}: {}", number, why)); };
  if (!is_finite(l.color) || l.color.x < 0 || l.color.y < 0 || l.color.z < 0)
    refuse("its colour is negative or not finite");
  if ((l.directional || l.spot) && !(std::abs(squared(l.direction) - 1) < 1e-6))
    refuse("its direction is not of length 1");
  if (l.directional) return;
  if (!is_finite(l.position)) refuse("its position is not finite");
  if (!(l.range >= 0)) refuse("its range is negative or not a number");
  if (l.spot && !(l.inner_cosine <= 1 && l.inner_cosine >= l.outer_cosine && l.outer_cosine >= -1))
    refuse("its cone is not -1 <= outer cosine <= inner cosine <= 1");
  if (l.shape != LightShape::point && (!is_finite(l.axis_u) || !is_finite(l.axis_v))) refuse("its size is not finite");
  const double size = l.shape == LightShape::point ? 0 : length(l.axis_u) + length(l.axis_v);
  const double far = length(l.position - scene.low) + size;
  if (scene.diagonal() > 0 && !(far <= kFurthestLight * scene.diagonal()))
    refuse("it is further from the scene, or larger, than 2^40 times the scene's size: make it directional");
}

void check_finite(const SceneFrame& frame) {
  SpaceBox box;
  for (std::size_t i = 0; i < frame.vertices.size(); ++i) {
    if (!is_finite(frame.vertices[i])) throw Error(fmt::format("vertex {}: position is not finite", i));
    box.add(frame.vertices[i]);
  }
  const Camera& c = frame.camera;
  if (!is_finite(c.eye) || !is_finite(c.right) || !is_finite(c.up) || !is_finite(c.forward) || !(c.near > 0) ||
      !std::isfinite(c.near) || !(c.half_height > 0) || !std::isfinite(c.half_height))
    throw Error("the camera is not finite, or its near plane or field of view is not positive");
  if (frame.lights.empty() || frame.lights.size() > kMaxLights)
    throw Error(fmt::format("{} lights: there must be 1 .. {}", frame.lights.size(), kMaxLights));
  for (std::size_t i = 0; i < frame.lights.size(); ++i) check_light(frame.lights[i], i, box);
}

void check_look(const Look& look) {
  if (look.samples < 1 || look.samples > kMaxSamples)
    throw Error(fmt::format("{} samples of a light: there must be 1 .. {}", look.samples, kMaxSamples));
  if (look.classes < 1 || look.classes > kMaxClasses)
    throw Error(fmt::format("{} classes of normals: there must be 1 .. {}", look.classes, kMaxClasses));
  if (!(look.darkening >= 0 && look.darkening <= 1)) throw Error("the darkening is not 0 .. 1");
  if (!(look.extrusion >= 1) || !std::isfinite(look.extrusion)) throw Error("the extrusion is not at least 1");
}

}  // namespace

FrameGeometry make_geometry(const SceneFrame& frame, const Config& config, int width, int height,
                            const GeometryOptions& options) {
  if (width < 1 || height < 1 || width > kMaxSize || height > kMaxSize)
    throw Error(fmt::format("size {}x{}: width and height must be 1 .. {}", width, height, kMaxSize));
  if (frame.polygons.empty()) throw Error("the scene has no faces");
  check_finite(frame);
  check_look(options.look);
  TranslucentOrder fresh_order;
  ShadowCache fresh_shadows;
  return Builder(frame, config, width, height, options.look, options.order != nullptr ? *options.order : fresh_order,
                 options.shadows != nullptr ? *options.shadows : fresh_shadows)
      .build();
}

}  // namespace kage
