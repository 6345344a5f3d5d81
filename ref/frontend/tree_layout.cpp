// SPDX-License-Identifier: Apache-2.0
#include "frontend/tree_layout.hpp"

#include <algorithm>
#include <array>

#include "frontend/units.hpp"

namespace kage {
namespace {

// Segments of a run that is longer than one.
int pieces(int length, int max_dx) { return (length + max_dx - 1) / max_dx; }

}  // namespace

TreeLayout::TreeLayout(const FrameGeometry& g, const Config& config)
    : g_(&g),
      config_(&config),
      unit_of_(g.polyhedra.size(), PolyhedraReport::kSpans),
      members_(static_cast<std::size_t>(config.units)) {
  if (config.units == 0) return;
  const int max_dx = derived::most_dx(config);
  PolyhedronScanner scanner(g, config);
  std::vector<UnitNeed> needs;
  const auto most = std::min(g.polyhedra.size(), std::size_t{1} << config.order_bits);
  for (std::size_t i = 0; i < most; ++i) {
    UnitNeed need;
    need.first = g.height;
    need.left = g.width;
    scanner.scan(g.polyhedra[i], 0, g.height, [&](int y, std::span<const Run> runs) {
      need.first = std::min(need.first, y);
      need.end = y + 1;
      int segments = 0;
      int at = runs[0].xl;
      for (const Run& r : runs) {
        // A gap within the body, which the snap can leave, is blank segments.
        segments += pieces(r.xl - at, max_dx) + pieces(r.xr - r.xl, max_dx);
        at = r.xr;
        need.left = std::min(need.left, r.xl);
        need.right = std::max(need.right, r.xr);
      }
      need.segments = std::max(need.segments, segments);
    });
    // Where one cannot be segments, it and all behind it are spans, so that ties stay as they are.
    if (!scanner.representable()) {
      stop_ = PolyhedraReport::Stop::depth;
      break;
    }
    if (need.end > 0) need.faces = static_cast<int>(g.polyhedra[i].polygon_count);
    needs.push_back(need);
  }
  const UnitRoom room{config.units, blank(), derived::most_segments(config), max_dx, g.width};
  const std::vector<int> units = assign_units(needs, room);
  if (units.size() < needs.size())
    stop_ = PolyhedraReport::Stop::no_unit;
  else if (stop_ == PolyhedraReport::Stop::none && most < g.polyhedra.size())
    stop_ = PolyhedraReport::Stop::index;
  std::vector<int> faces(members_.size(), 0);
  for (std::uint32_t i = 0; i < units.size(); ++i) {
    unit_of_[i] = needs[i].end == 0 ? PolyhedraReport::kUnseen : units[i];
    first_span_polygon_ = g.polyhedra[i].first_polygon + g.polyhedra[i].polygon_count;
    if (needs[i].end == 0) continue;  // not to be seen
    any_ = true;
    const auto u = static_cast<std::size_t>(units[i]);
    members_[u].push_back({i, faces[u]});
    faces[u] += needs[i].faces;
  }
}

void TreeLayout::faces(TokenWriter& writer) const {
  const SpanSetup setup = SpanSetup::depth(*config_);
  for (std::size_t u = 0; u < members_.size(); ++u)
    for (const Member& m : members_[u]) {
      const Polyhedron& p = g_->polyhedra[m.polyhedron];
      for (std::uint32_t k = 0; k < p.polygon_count; ++k) {
        const ScreenPolygon& polygon = g_->polygons[p.first_polygon + k];
        SegmentToken t;
        t.unit = static_cast<int>(u);
        t.face = m.first_face + static_cast<int>(k);
        t.index = static_cast<int>(m.polyhedron);
        t.normal_class = span_class(polygon, *config_);
        t.dz = setup.step(polygon.depth);
        for (std::size_t c = 0; c < 3; ++c)
          t.color[c] = polygon.light_planes < 0 ? polygon.color[c] : light(polygon, c);
        writer.face(t);
      }
    }
}

// A channel of the light from everywhere, which is the same all over the polygon, as a pixel holds it of a span.
std::int32_t TreeLayout::light(const ScreenPolygon& polygon, std::size_t channel) const {
  const int bits = derived::pixel_level_bits(*config_);
  const ScreenPlane& plane = g_->color_planes[static_cast<std::size_t>(polygon.light_planes) + channel];
  const std::int64_t start = SpanSetup::color(*config_, bits).at(plane, plane.x0, plane.y0, 1).start;
  return static_cast<std::int32_t>(std::min(start >> (config_->color_frac + 8 - bits), (std::int64_t{1} << bits) - 1));
}

std::vector<LineRange> TreeLayout::edge_lines() const {
  std::vector<LineRange> lines(g_->polyhedron_edges.size());
  for (const auto& unit : members_)
    for (const Member& m : unit) {
      const Polyhedron& p = g_->polyhedra[m.polyhedron];
      for (std::uint32_t i = p.first_edge; i < p.first_edge + p.edge_count; ++i)
        lines[i] = lines_of(g_->polyhedron_edges[i].from, g_->polyhedron_edges[i].to);
    }
  return lines;
}

void TreeLayout::segments(int y0, int y1, std::span<const std::uint32_t> edges,
                          std::vector<std::vector<std::uint32_t>>& lines) const {
  struct FaceRun {
    Run run;
    int face;
    std::int64_t step;
  };
  const SpanSetup setup = SpanSetup::depth(*config_);
  const int max_dx = derived::most_dx(*config_);
  PolyhedronScanner scanner(*g_, *config_);
  std::vector<std::vector<FaceRun>> runs;
  lines.resize(static_cast<std::size_t>(y1 - y0));
  for (auto& line : lines) line.clear();
  std::vector<std::uint32_t> none;
  TokenWriter writer(*config_, none);
  for (std::size_t u = 0; u < members_.size(); ++u) {
    runs.resize(lines.size());
    for (auto& line : runs) line.clear();
    for (const Member& m : members_[u]) {
      const Polyhedron& p = g_->polyhedra[m.polyhedron];
      const auto first = std::lower_bound(edges.begin(), edges.end(), p.first_edge);
      const auto end = std::lower_bound(first, edges.end(), p.first_edge + p.edge_count);
      if (first == end) continue;
      scanner.scan(p, {first, end}, y0, y1, [&](int y, std::span<const Run> found) {
        for (const Run& r : found)
          runs[static_cast<std::size_t>(y - y0)].push_back(
              {r, m.first_face + static_cast<int>(r.polygon - p.first_polygon),
               setup.step(g_->polygons[r.polygon].depth)});
      });
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::sort(runs[i].begin(), runs[i].end(), [](const FaceRun& a, const FaceRun& b) { return a.run.xl < b.run.xl; });
      writer.write_to(lines[i]);
      SegmentToken t;
      t.unit = static_cast<int>(u);
      int at = 0;
      const auto put = [&](int end, int face, std::int64_t z, std::int64_t step) {
        for (; at < end; at += t.dx) {
          t.sync = at == 0;
          t.face = face;
          t.z = z;
          t.dx = std::min(end - at, max_dx);
          writer.seg(t);
          z += t.dx * step;
        }
      };
      for (const FaceRun& r : runs[i]) {
        put(r.run.xl, blank(), 0, 0);
        put(r.run.xr, r.face, r.run.z, r.step);
      }
      put(g_->width, blank(), 0, 0);
    }
  }
}

PolyhedraReport TreeLayout::report() const {
  PolyhedraReport r;
  r.unit_of = unit_of_;
  r.stop = stop_;
  for (const auto& m : members_) r.units += m.empty() ? 0 : 1;
  return r;
}

}  // namespace kage
