// SPDX-License-Identifier: Apache-2.0
#include "shadow/kept.hpp"

#include <algorithm>

namespace kage {

ShadowCache::ShadowCache() : data_(std::make_unique<Data>()) {}
ShadowCache::~ShadowCache() = default;
ShadowCache::ShadowCache(ShadowCache&&) noexcept = default;
ShadowCache& ShadowCache::operator=(ShadowCache&&) noexcept = default;

void ShadowCache::Data::take(const SceneFrame& frame, int limit, VolumeWay way) {
  std::vector<Part> parts;
  parts.reserve(frame.components.size());
  for (const Component& c : frame.components)
    parts.push_back({c.first_polygon, c.polygon_count, c.closed, c.convex, c.translucent});
  std::vector<Face> faces;
  faces.reserve(frame.polygons.size());
  for (const Polygon& p : frame.polygons) faces.push_back({p.first, p.count, frame.triangles[p.triangle].vertex});
  if (limit != limit_ || way != way_ || parts != parts_ || faces != faces_ || frame.corners != corners_ ||
      frame.vertices.size() != vertices_.size()) {
    limit_ = limit;
    way_ = way;
    parts_ = std::move(parts);
    faces_ = std::move(faces);
    corners_ = frame.corners;
    vertices_ = frame.vertices;
    edges_.emplace(frame);
    samples_.clear();
    return;
  }
  bool any = false;
  for (std::size_t c = 0; c < parts_.size(); ++c) {
    const auto own = std::span(faces_).subspan(parts_[c].first_polygon, parts_[c].polygon_count);
    const auto moved = [&](std::uint32_t v) { return frame.vertices[v] != vertices_[v]; };
    const bool any_moved = std::any_of(own.begin(), own.end(), [&](const Face& f) {
      const auto outline = std::span(corners_).subspan(f.first, f.count);
      return std::any_of(outline.begin(), outline.end(), moved) || std::any_of(f.plane.begin(), f.plane.end(), moved);
    });
    if (!any_moved) continue;
    any = true;
    for (KeptSample& s : samples_) s.patches[c].reset();
  }
  if (!any) return;
  for (KeptSample& s : samples_) s.volumes.reset();
  vertices_ = frame.vertices;
}

KeptSample& ShadowCache::Data::sample(std::size_t number, const ShadowCaster& caster) {
  if (samples_.size() <= number) samples_.resize(number + 1);
  KeptSample& s = samples_[number];
  const LightPoint& l = caster.light();
  const bool same = s.light.directional == l.directional && s.light.direction == l.direction &&
                    s.light.position == l.position && s.edge_on == caster.edge_on();
  if (!same || s.patches.size() != parts_.size()) {
    s = {};
    s.light = l;
    s.edge_on = caster.edge_on();
    s.patches.resize(parts_.size());
  }
  return s;
}

}  // namespace kage
