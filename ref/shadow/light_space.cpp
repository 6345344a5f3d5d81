// SPDX-License-Identifier: Apache-2.0
#include "shadow/light_space.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scene/space.hpp"

namespace kage {
namespace {

// A point light sees all casters in one chart if none is further than this from the chart's axis: the cosine.
constexpr double kCone = 0.2;
// A cube's side reaches to 1, and what is further out than this is cut off.
constexpr double kClip = 1.5;
// A chart's edge stays this many steps within the square that bound_count() looks at.
constexpr double kChartMargin = 4;
// More than all roundings on the way to a direction from the light.
constexpr double kNear = 1e-9;

std::array<glm::dvec3, 3> axes(const glm::dvec3& to_light) {
  const glm::dvec3 z = to_light / length(to_light);
  // Not along the world's axes, which scenes love: their edges would lie on those of the charts.
  const glm::dvec3 other = std::abs(z.x) < 0.7 ? glm::dvec3(0.9, 0.3, 0.2) : glm::dvec3(0.2, 0.9, 0.3);
  const glm::dvec3 x = glm::cross(other, z);
  const glm::dvec3 right = x / length(x);
  return {right, glm::cross(z, right), z};
}

}  // namespace

void LightBox::add(const LightBox& o) {
  for (std::size_t i = 0; i < 2; ++i) {
    low[i] = std::min(low[i], o.low[i]);
    high[i] = std::max(high[i], o.high[i]);
  }
}

LightSpace::LightSpace(const SceneFrame& frame, const LightPoint& light, std::span<const CapFace> caps)
    : frame_(&frame), light_(light), axes_(axes(-light.direction)) {
  const auto each_vertex = [&](auto see) {
    for (const CapFace& cap : caps)
      for (const std::uint32_t v : frame.outline(frame.polygons[cap.polygon])) see(v);
  };
  if (!light.directional) {
    SpaceBox bounds;
    each_vertex([&](std::uint32_t v) { bounds.add(frame.vertices[v]); });
    const glm::dvec3 to = light.position - (bounds.low + bounds.high) * 0.5;
    axes_ = axes(length(to) > 0 ? to : glm::dvec3(0, 1, 0));
    each_vertex([&](std::uint32_t v) {
      const glm::dvec3 p = place(v);
      if (-p.z < kCone * length(p)) charts_ = 6;
    });
    if (charts_ > 1) return;
  }
  Flat least{INFINITY, INFINITY};
  Flat most{-INFINITY, -INFINITY};
  each_vertex([&](std::uint32_t v) {
    const Flat f = flat(place(v));
    least = {std::min(least.x, f.x), std::min(least.y, f.y)};
    most = {std::max(most.x, f.x), std::max(most.y, f.y)};
  });
  if (!(least.x <= most.x)) return;
  middle_ = {(least.x + most.x) / 2, (least.y + most.y) / 2};
  half_ = std::max(most.x - least.x, most.y - least.y) / 2;
  if (!(half_ > 0)) half_ = 1;
}

// Along the axes, from the light (point) or from the world's origin (directional). The light looks along -z.
glm::dvec3 LightSpace::place(std::uint32_t vertex) const {
  const glm::dvec3 p = light_.directional ? frame_->vertices[vertex] : frame_->vertices[vertex] - light_.position;
  return {glm::dot(p, axes_[0]), glm::dot(p, axes_[1]), glm::dot(p, axes_[2])};
}

// The cube's side that is looked at is turned to -z.
glm::dvec3 LightSpace::turned(const glm::dvec3& p, int chart) {
  switch (chart) {
    case 0:
      return p;
    case 1:
      return {-p.x, p.y, -p.z};
    case 2:
      return {p.z, p.y, -p.x};
    case 3:
      return {-p.z, p.y, p.x};
    case 4:
      return {p.x, p.z, -p.y};
    default:
      return {p.x, -p.z, p.y};
  }
}

LightSpace::Flat LightSpace::flat(const glm::dvec3& p) const {
  if (light_.directional) return {p.x, p.y};
  return {p.x / -p.z, p.y / -p.z};
}

ChartPoint LightSpace::on_chart(const Flat& f) const {
  // An edge that passes the light as close as rounding may be cut anywhere.
  const auto even = [this](double v, double middle) {
    const double on = std::clamp((v - middle) / half_, -1.9, 1.9);
    return 2 * static_cast<std::int64_t>(std::floor(on * (static_cast<double>(kChartHalf) / 2 - kChartMargin) + 0.5));
  };
  return {even(f.x, middle_.x), even(f.y, middle_.y)};
}

// Cuts an edge down to its part that lies before the light and not far outside the cube's side; false if there is none.
bool LightSpace::clip(glm::dvec3& a, glm::dvec3& b) const {
  if (charts_ == 1) return true;
  for (int i = 0; i < 4; ++i) {
    const auto distance = [i](const glm::dvec3& p) {
      return -kClip * p.z + (i == 0 ? p.x : i == 1 ? -p.x : i == 2 ? p.y : -p.y);
    };
    const double da = distance(a);
    const double db = distance(b);
    if (da <= 0 && db <= 0) return false;
    if (da >= 0 && db >= 0) continue;
    // From inside to outside, whichever way round the edge is.
    const glm::dvec3 cut = da > 0 ? a + da / (da - db) * (b - a) : b + db / (db - da) * (a - b);
    (da > 0 ? b : a) = cut;
  }
  return a.z < 0 && b.z < 0;
}

// Caps that hold the direction of a chart's lower left corner, or may: too many does no harm.
int LightSpace::corner_count(int chart, std::span<const CapFace> caps) const {
  const glm::dvec3 d{-1, -1, -1};
  int count = 0;
  for (const CapFace& cap : caps) {
    const auto corners = frame_->outline(frame_->polygons[cap.polygon]);
    bool holds = true;
    bool ahead = false;
    glm::dvec3 p = turned(place(corners.back()), chart);
    for (const std::uint32_t v : corners) {
      const glm::dvec3 q = turned(place(v), chart);
      const double s = glm::dot(d, glm::cross(p, q)) * (cap.turned ? -1 : 1);
      // Seen from the light counter-clockwise; a cross product's rounding is a small part of the lengths.
      holds = holds && s <= kNear * length(p) * length(q);
      ahead = ahead || glm::dot(d, q) > -kNear * length(q);
      p = q;
    }
    if (holds && ahead) ++count;
  }
  return count;
}

CountRange LightSpace::count(std::span<const CapFace> caps, std::span<const SideEdge> sides, int target) const {
  CountRange all;
  std::vector<ChartEdge> edges;
  for (int chart = 0; chart < charts_; ++chart) {
    edges.clear();
    for (const SideEdge& s : sides) {
      glm::dvec3 a = turned(place(s.a), chart);
      glm::dvec3 b = turned(place(s.b), chart);
      if (clip(a, b)) edges.push_back({on_chart(flat(a)), on_chart(flat(b)), s.w});
    }
    const CountRange r = bound_count(edges, charts_ == 1 ? 0 : corner_count(chart, caps), target);
    all.low = std::max(all.low, r.low);
    all.high = std::max(all.high, r.high);
  }
  return all;
}

// With six charts: where directions of length 1 lie over the x-y plane. A face's directions go up to the sagitta beyond
// those of its corners, which is below the square of the longest chord.
LightBox LightSpace::box(const Polygon& p) const {
  LightBox box{{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
  const auto corners = frame_->outline(p);
  std::vector<glm::dvec3> unit;
  for (const std::uint32_t v : corners) {
    const glm::dvec3 q = place(v);
    if (charts_ > 1) unit.push_back(q / length(q));
    const Flat f = charts_ > 1 ? Flat{unit.back().x, unit.back().y} : flat(q);
    box.add({{f.x, f.y}, {f.x, f.y}});
  }
  double chord2 = 0;
  for (const glm::dvec3& a : unit)
    for (const glm::dvec3& b : unit) chord2 = std::max(chord2, squared(a - b));
  const double more = chord2 < 1 ? chord2 + 1e-12 : 2;
  const double margin = charts_ > 1 ? more : 1e-12 * (half_ + std::abs(middle_.x) + std::abs(middle_.y));
  for (std::size_t i = 0; i < 2; ++i) {
    box.low[i] -= margin;
    box.high[i] += margin;
  }
  return box;
}

}  // namespace kage
