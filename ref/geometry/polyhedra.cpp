// SPDX-License-Identifier: Apache-2.0
#include "geometry/polyhedra.hpp"

#include <algorithm>
#include <tuple>

#include "number/int128.hpp"

namespace kage {
namespace {

// Counter-clockwise from outside is clockwise with y down, when seen from the front: a positive area is the back.
bool is_turned_away(std::span<const ScreenVertex> outline) {
  Int128 area = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ScreenVertex& a = outline[i];
    const ScreenVertex& b = outline[(i + 1) % outline.size()];
    area += Int128{a.x} * b.y - Int128{b.x} * a.y;
  }
  return area > 0;
}

/// An edge as one of its faces has it.
struct EdgeSide {
  std::uint32_t low;
  std::uint32_t high;
  bool along;
  std::uint32_t polygon;
};

}  // namespace

// The reasons for spans that are known before a face is drawn.
SpanReason PolyhedronDrawer::reason_of(const Component& part) const {
  if (part.translucent) return SpanReason::translucent;
  if (!part.closed) return SpanReason::not_closed;
  if (!part.convex) return SpanReason::not_convex;
  const auto faces = std::span(frame_->polygons).subspan(part.first_polygon, part.polygon_count);
  for (const Polygon& face : faces)
    for (const std::uint32_t v : frame_->outline(face))
      if (!drawer_->points().screen[v].kept) return SpanReason::cut;
  if (look_->cull && std::any_of(faces.begin(), faces.end(), [&](const Polygon& face) {
        return frame_->triangles[face.triangle].sides == Sides::back;
      }))
    return SpanReason::culled;
  return SpanReason::none;
}

SpanReason PolyhedronDrawer::draw(std::uint32_t component, std::vector<std::uint32_t>& turned_away) {
  const Component& part = frame_->components[component];
  if (const SpanReason reason = reason_of(part); reason != SpanReason::none) return reason;
  const FaceDrawer::Mark before = drawer_->mark();
  const std::size_t polygons = before.polygons;
  const std::size_t turned_away_before = turned_away.size();
  for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
    drawer_->draw(i);
    if (out_->polygons.back().color_planes >= 0) {
      drawer_->undo_to(before);
      turned_away.resize(turned_away_before);
      return SpanReason::colors;
    }
    if (is_turned_away(out_->outline(out_->polygons.back()))) {
      drawer_->undo(i);
      turned_away.push_back(i);
    }
  }
  Polyhedron p;
  p.component = component;
  p.first_polygon = static_cast<std::uint32_t>(polygons);
  p.polygon_count = static_cast<std::uint32_t>(out_->polygons.size() - polygons);
  p.first_edge = static_cast<std::uint32_t>(out_->polyhedron_edges.size());
  add_edges(part);
  p.edge_count = static_cast<std::uint32_t>(out_->polyhedron_edges.size()) - p.first_edge;
  out_->polyhedra.push_back(p);
  return SpanReason::none;
}

// Each edge once, from its lower vertex to its higher one.
void PolyhedronDrawer::add_edges(const Component& part) {
  std::vector<EdgeSide> sides;
  for (std::uint32_t i = part.first_polygon; i < part.first_polygon + part.polygon_count; ++i) {
    const auto corners = frame_->outline(frame_->polygons[i]);
    const DrawnRange& drawn = drawer_->drawn()[i];
    const std::uint32_t polygon = drawn.count == 0 ? PolyhedronEdge::kNoPolygon : drawn.first;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::uint32_t a = corners[k];
      const std::uint32_t b = corners[(k + 1) % corners.size()];
      sides.push_back({std::min(a, b), std::max(a, b), a < b, polygon});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const EdgeSide& p, const EdgeSide& q) {
    return std::tie(p.low, p.high, p.along) < std::tie(q.low, q.high, q.along);
  });
  // Closed: sides come in pairs, one each way.
  const std::vector<ScreenPoint>& screen = drawer_->points().screen;
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2) {
    const EdgeSide& against = sides[i];
    const EdgeSide& along = sides[i + 1];
    if (along.polygon == PolyhedronEdge::kNoPolygon && against.polygon == PolyhedronEdge::kNoPolygon) continue;
    out_->polyhedron_edges.push_back(
        {screen[along.low].vertex.at, screen[along.high].vertex.at, along.polygon, against.polygon});
  }
}

}  // namespace kage
