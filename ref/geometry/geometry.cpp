// SPDX-License-Identifier: Apache-2.0
#include "kage/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "contract/derived.hpp"
#include "geometry/check_input.hpp"
#include "geometry/face_drawer.hpp"
#include "geometry/face_shading.hpp"
#include "geometry/facing.hpp"
#include "geometry/light_table.hpp"
#include "geometry/polyhedra.hpp"
#include "geometry/sampled_lights.hpp"
#include "geometry/seen.hpp"
#include "geometry/translucent.hpp"
#include "geometry/volume_maker.hpp"
#include "kage/error.hpp"
#include "number/packed_color.hpp"
#include "shadow/kept.hpp"
#include "shadow/receivers.hpp"
#include "shadow/volumes.hpp"

namespace kage {
namespace {

// Input of a frame's geometry: the scene's frame, the configuration and the look.
struct Task {
  const SceneFrame& frame;
  const Config& config;
  const Look& look;
};

FrameGeometry empty_geometry(const Task& task, int width, int height, const SampledLights& lights) {
  FrameGeometry out;
  out.width = width;
  out.height = height;
  const auto& background = task.look.background;
  out.background = task.config.channels == 1 ? background[1] : packed_color(background);
  out.sample_light = lights.light_of;
  if (task.config.linear_bits > 0)
    for (std::size_t l = 0; l < task.frame.lights.size(); ++l) out.passes.push_back(lights.points_of(l));
  out.sub_bits = task.look.sub_bits;
  out.polygons.reserve(task.frame.polygons.size());
  out.vertices.reserve(task.frame.corners.size());
  return out;
}

void draw_component(const Task& task, const Component& part, FaceDrawer& drawer,
                    std::vector<std::uint32_t>& turned_away) {
  for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
    const Triangle& t = task.frame.triangles[task.frame.polygons[i].triangle];
    if (is_culled(task.frame, task.look, i, facing_of(task.frame, t, normal_of(task.frame, t))))
      turned_away.push_back(i);
    else
      drawer.draw(i);
  }
}

// Polyhedra first, then the rest, each in the scene's order: whether a polyhedron goes to a unit or becomes spans
// changes no tie. The faces that are not drawn because they are turned away are returned.
std::vector<std::uint32_t> draw_all(const Task& task, FaceDrawer& drawer, FrameGeometry& out) {
  std::vector<std::uint32_t> turned_away;
  const std::vector<Component>& parts = task.frame.components;
  PolyhedronDrawer polyhedra(task.frame, task.look, drawer, out);
  for (std::uint32_t c = 0; c < parts.size(); ++c) out.span_reasons.push_back(polyhedra.draw(c, turned_away));
  for (std::uint32_t c = 0; c < parts.size(); ++c)
    if (out.span_reasons[c] != SpanReason::none && !parts[c].translucent)
      draw_component(task, parts[c], drawer, turned_away);
  if (task.config.translucency > 0) return turned_away;
  for (const Component& part : parts)
    if (part.translucent) draw_component(task, part, drawer, turned_away);
  return turned_away;
}

// Faces and edges of those that go, go too: the front end draws all that there are.
void keep_first_volumes(FrameGeometry& out) {
  std::vector<ShadowVolume> volumes;
  std::vector<VolumeFace> faces;
  std::vector<NearEdge> edges;
  for (ShadowVolume v : out.volumes) {
    if (!volumes.empty() && volumes.back().sample == v.sample) continue;
    const auto own_faces = std::span(out.volume_faces).subspan(v.first_face, v.face_count);
    const auto own_edges = std::span(out.near_edges).subspan(v.first_near, v.near_count);
    v.first_face = static_cast<std::uint32_t>(faces.size());
    v.first_near = static_cast<std::uint32_t>(edges.size());
    faces.insert(faces.end(), own_faces.begin(), own_faces.end());
    edges.insert(edges.end(), own_edges.begin(), own_edges.end());
    volumes.push_back(v);
  }
  out.left_out = static_cast<std::uint32_t>(out.volumes.size() - volumes.size());
  out.volumes = std::move(volumes);
  out.volume_faces = std::move(faces);
  out.near_edges = std::move(edges);
}

void make_volumes(const Task& task, const SampledLights& lights, double near, VolumeMaker& maker, ShadowCache& cache,
                  FrameGeometry& out) {
  const std::vector<SpaceBox> boxes = component_boxes(task.frame);
  VolumeCaster volumes(task.frame, boxes, task.config.dsf_bits, task.look.volumes, ShadowCacheInside::of(cache));
  std::optional<Receivers> receivers;
  if (task.look.leave_out)
    receivers.emplace(task.frame, boxes, near, out.width, out.height, task.config.translucency == 0);
  std::vector<bool> casts(task.frame.components.size(), true);
  for (std::uint32_t i = 0; i < lights.samples().size(); ++i) {
    const ShadowCaster& caster = lights.samples()[i];
    if (receivers) casts = receivers->reached(caster.light());
    volumes.make(i, caster,
                 [&](const WorldVolume& v, std::uint32_t component) { maker.add(v, caster, i, component, casts); });
  }
  if (task.look.fit && task.config.fsf == 0) keep_first_volumes(out);
}

// Faces that the eye sees edge-on cover nothing, whatever the snap makes of them; nor do those of alpha 0.
void draw_translucent(const Task& task, const View& view, FaceDrawer& drawer, TranslucentOrder& order,
                      FrameGeometry& out) {
  const SceneFrame& frame = task.frame;
  std::vector<std::uint32_t> faces;
  for (const Component& part : frame.components)
    for (std::uint32_t i = part.first_polygon; part.translucent && i < part.first_polygon + part.polygon_count; ++i)
      if (frame.triangles[frame.polygons[i].triangle].alpha > 0) faces.push_back(i);
  if (faces.empty()) return;
  std::vector<int> sides;
  sides.reserve(faces.size());
  for (const std::uint32_t i : faces) {
    sides.push_back(eye_side(frame.camera, triangle_of(frame, i)));
    if (sides.back() != 0 && !is_culled(frame, task.look, i, sides.back())) drawer.draw(i);
  }
  const std::vector<DrawnRange>& drawn = drawer.drawn();
  FragmentMaker(frame, view, TranslucentOrderInside::of(order), faces, sides)
      .make(
          task.look.translucent, [&](std::uint32_t face) { return std::pair(drawn[face].first, drawn[face].count); },
          out);
}

FrameGeometry build(const Task& task, int width, int height, TranslucentOrder& order, ShadowCache& shadows) {
  const auto& [frame, config, look] = task;
  std::vector<EyePoint> points = eye_points(frame);
  const View view(frame.camera, width, height, config.z_bits, depth_range(frame, config, width, height, look, points),
                  look.sub_bits);
  const SampledLights lights(frame, config, look, view.near_corners());
  const Lighting lighting(frame.lights, lights, frame.camera.up, config.channels == 1);
  const LightTable table(frame, config, look, lights, lighting);
  const FaceShading shading(frame, config, lights, lighting, table);
  FrameGeometry out = empty_geometry(task, width, height, lights);
  table.put(out);
  Clipper clipper(view.near(), view.volume_end(), look.sub_bits);
  FaceDrawer drawer(frame, std::move(points), config, view, clipper, shading, look.max_shading, out);

  const std::vector<std::uint32_t> turned_away = draw_all(task, drawer, out);
  out.drawn = static_cast<std::uint32_t>(out.polygons.size());
  if (config.dsf_bits > 0) {
    for (const std::uint32_t i : turned_away) drawer.draw_unseen(i);  // what is turned away may still be a cap
    VolumeMaker maker(frame, view, clipper, drawer.points().eye, drawer.drawn(), look.far_ends, out);
    make_volumes(task, lights, view.near(), maker, shadows, out);
  }
  if (config.translucency > 0) draw_translucent(task, view, drawer, order, out);
  return out;
}

}  // namespace

namespace {

// Light within a face is looked at in so many parts of each edge; in more where the face is a large part of all.
constexpr int kFewParts = 2;
constexpr int kManyParts = 16;
constexpr double kLargeFace = 1.0 / 256;

}  // namespace

LightDemand light_demand(const SceneFrame& frame, const Config& config, const Look& look) {
  check_finite(frame);
  check_look(look);
  const SampledLights lights(frame, config, look, {});
  const Lighting lighting(frame.lights, lights, frame.camera.up, false);
  const LightTable table(frame, config, look, lights, lighting);
  const FaceShading shading(frame, config, lights, lighting, table);
  LightDemand demand{std::hypot(table.error(), table.law_error()), 0};
  if (std::all_of(frame.lights.begin(), frame.lights.end(), [](const Light& l) { return l.directional; }))
    return demand;
  const auto area_of = [&](std::uint32_t i) {
    const auto outline = frame.outline(frame.polygons[i]);
    double area = 0;
    for (std::size_t k = 1; k + 1 < outline.size(); ++k) {
      const glm::dvec3& a = frame.vertices[outline[0]];
      area += glm::length(glm::cross(frame.vertices[outline[k]] - a, frame.vertices[outline[k + 1]] - a));
    }
    return area;
  };
  double all = 0;
  for (std::uint32_t i = 0; i < frame.polygons.size(); ++i) all += area_of(i);
  std::vector<ClipPoint> corners;
  for (std::uint32_t i = 0; i < frame.polygons.size(); ++i) {
    const auto outline = frame.outline(frame.polygons[i]);
    corners.resize(outline.size());
    const FaceShading::Shaded face = shading.shade(i, corners);
    const auto see = [&](const glm::dvec3& color) {
      for (int c = 0; c < 3; ++c)
        demand.color_spread = std::max(demand.color_spread, std::abs(color[c] - face.mean[c]));
    };
    for (const ClipPoint& corner : corners) see(corner.color);
    if (!face.varies) continue;
    const int parts = area_of(i) > all * kLargeFace ? kManyParts : kFewParts;
    for (std::size_t k = 1; k + 1 < outline.size(); ++k) {
      const glm::dvec3& a = frame.vertices[outline[0]];
      const glm::dvec3 u = (frame.vertices[outline[k]] - a) / static_cast<double>(parts);
      const glm::dvec3 v = (frame.vertices[outline[k + 1]] - a) / static_cast<double>(parts);
      for (int y = 0; y <= parts; ++y)
        for (int x = 0; x + y <= parts; ++x)
          see(glm::min(
              shading.color_at(face, a + static_cast<double>(x) * u + static_cast<double>(y) * v) * face.factor,
              glm::dvec3(255)));
    }
  }
  return demand;
}

FrameGeometry make_geometry(const SceneFrame& frame, const Config& config, int width, int height,
                            const GeometryOptions& options) {
  if (width < 1 || height < 1 || width > kMaxSize || height > kMaxSize)
    throw Error(fmt::format("size {}x{}: width and height must be 1 .. {}", width, height, kMaxSize));
  if (frame.polygons.empty()) throw Error("the scene has no faces");
  check_finite(frame);
  check_look(options.look);
  TranslucentOrder fresh_order;
  ShadowCache fresh_shadows;
  return build({frame, config, options.look}, width, height, options.order != nullptr ? *options.order : fresh_order,
               options.shadows != nullptr ? *options.shadows : fresh_shadows);
}

}  // namespace kage
