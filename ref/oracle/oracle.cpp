// SPDX-License-Identifier: Apache-2.0
#include "kage/oracle.hpp"

#include <algorithm>
#include <array>

#include "number/int128.hpp"

namespace kage {
namespace {

// Depth at a pixel centre in 2^-24 LSB, held to what a pixel can store.
Int128 depth(const ScreenPlane& p, int x, int y, int z_bits) {
  const Int128 unit = static_cast<Int128>(1) << kPlaneFrac;
  const Int128 v = Int128{p.a} * (x - p.x0) + Int128{p.b} * (y - p.y0) + p.c;
  return std::clamp(v, unit, ((unit << z_bits) - 2 * unit));
}

bool meets_line(std::span<const ScreenVertex> outline, int y) {
  const int centre = 256 * y + 128;
  bool above = false;
  bool below = false;
  for (const ScreenVertex& v : outline) {
    above = above || v.y <= centre;
    below = below || v.y > centre;
  }
  return above && below;
}

// +1, -1 or 0: what the edge adds to the winding number round a point.
int edge_winding(const ScreenVertex& a, const ScreenVertex& b, std::int64_t px, std::int64_t py) {
  if ((a.y <= py) == (b.y <= py)) return 0;
  // Twice the signed area of (a, b, point). For an edge that goes down it is <= 0 where the point is right of it or on
  // it.
  const std::int64_t area = (std::int64_t{b.x} - a.x) * (py - a.y) - (std::int64_t{b.y} - a.y) * (px - a.x);
  if (a.y <= py) return area <= 0 ? 1 : 0;
  return area >= 0 ? -1 : 0;
}

}  // namespace

Oracle::Oracle(const FrameGeometry& geometry, const Config& config) : g_(&geometry), config_(config) { line(0); }

void Oracle::line(int y) {
  y_ = y;
  drawn_.clear();
  for (std::uint32_t i = 0; i < g_->drawn; ++i)
    if (meets_line(g_->outline(g_->polygons[i]), y)) drawn_.push_back(i);
  volumes_.clear();
  for (std::uint32_t i = 0; i < g_->volumes.size(); ++i) {
    const ShadowVolume& from = g_->volumes[i];
    Volume v;
    v.index = i;
    for (const VolumeFace& f : std::span(g_->volume_faces).subspan(from.first_face, from.face_count))
      if (meets_line(g_->outline(g_->polygons[f.polygon]), y)) v.faces.push_back({f.polygon, f.w});
    for (const NearEdge& e : std::span(g_->near_edges).subspan(from.first_near, from.near_count))
      if (meets_line(std::array{e.from, e.to}, y)) v.near.push_back(e);
    if (!v.faces.empty() || !v.near.empty()) volumes_.push_back(std::move(v));
  }
}

int Oracle::winding(std::span<const ScreenVertex> outline, int x, int y) {
  int sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    sum += edge_winding(outline[i], outline[(i + 1) % outline.size()], std::int64_t{256} * x + 128,
                        std::int64_t{256} * y + 128);
  return sum;
}

bool Oracle::covers(std::uint32_t polygon, int x) const {
  return winding(g_->outline(g_->polygons[polygon]), x, y_) != 0;
}

bool Oracle::nearer(const ScreenPlane& a, const ScreenPlane& b, int x) const {
  return depth(a, x, y_, config_.z_bits) < depth(b, x, y_, config_.z_bits);
}

bool Oracle::within_error(const ScreenPlane& a, const ScreenPlane& b, int x) const {
  // Each depth is off by (k + 1) 2^-(Z_FRAC+1) at most, k <= x, and then rounded to a whole LSB, by 1/2 at most.
  const Int128 unit = static_cast<Int128>(1) << kPlaneFrac;
  const Int128 bound = unit + 2 * (((static_cast<Int128>(x) + 1) << kPlaneFrac) >> (config_.z_frac + 1));
  const Int128 gap = depth(a, x, y_, config_.z_bits) - depth(b, x, y_, config_.z_bits);
  return gap <= bound && -gap <= bound;
}

int Oracle::near_cap(const Volume& v, int x) const {
  int sum = 0;
  for (const NearEdge& e : v.near)
    sum += edge_winding(e.from, e.to, std::int64_t{256} * x + 128, std::int64_t{256} * y_ + 128);
  return sum;
}

OraclePixel Oracle::at(int x) const {
  OraclePixel p;
  for (const std::uint32_t i : drawn_) {
    if (!covers(i, x)) continue;
    if (p.surface < 0 || nearer(g_->polygons[i].depth, g_->polygons[static_cast<std::uint32_t>(p.surface)].depth, x))
      p.surface = static_cast<std::int32_t>(i);
  }
  if (p.surface < 0) return p;
  const int mask = (1 << config_.dsf_bits) - 1;
  for (const Volume& v : volumes_) {
    int sum = near_cap(v, x);
    for (const Face& f : v.faces) {
      const ScreenPolygon& face = g_->polygons[f.polygon];
      if (nearer(face.depth, g_->polygons[static_cast<std::uint32_t>(p.surface)].depth, x))
        sum += f.w * winding(g_->outline(face), x, y_);
    }
    if ((sum & mask) != 0) p.shadowed = true;
  }
  return p;
}

Verdict Oracle::judge_surface(int x, const OraclePixel& truth, std::int32_t seen) const {
  if (seen == truth.surface) return Verdict::right;
  if (seen < 0 || truth.surface < 0 || !covers(static_cast<std::uint32_t>(seen), x)) return Verdict::gross;
  return within_error(g_->polygons[static_cast<std::uint32_t>(seen)].depth,
                      g_->polygons[static_cast<std::uint32_t>(truth.surface)].depth, x)
             ? Verdict::near_tie
             : Verdict::gross;
}

Verdict Oracle::judge_shadow(int x, const OraclePixel& truth, bool seen) const {
  if (seen == truth.shadowed || truth.surface < 0) return Verdict::right;
  const ScreenPlane& surface = g_->polygons[static_cast<std::uint32_t>(truth.surface)].depth;
  for (const Volume& v : volumes_)
    for (const Face& f : v.faces) {
      const ScreenPolygon& face = g_->polygons[f.polygon];
      // The surface's own plane is the same numbers on both sides: no error can part them.
      if (static_cast<std::int32_t>(f.polygon) != truth.surface && within_error(face.depth, surface, x) &&
          winding(g_->outline(face), x, y_) != 0)
        return Verdict::near_tie;
    }
  return Verdict::gross;
}

int Oracle::sum_of_toggles(std::uint32_t volume, int x) const {
  for (const Volume& v : volumes_) {
    if (v.index != volume) continue;
    int sum = near_cap(v, x);
    for (const Face& f : v.faces) sum += f.w * winding(g_->outline(g_->polygons[f.polygon]), x, y_);
    return sum;
  }
  return 0;
}

}  // namespace kage
