// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle.hpp"

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

// +1, -1 or 0: what the edge adds to the winding number round a point.
int edge_winding(const ScreenVertex& a, const ScreenVertex& b, std::int64_t px, std::int64_t py) {
  if ((a.y <= py) == (b.y <= py)) return 0;
  // Twice the signed area of (a, b, point). For an edge that goes down it is <= 0 where the point is right of it or on
  // it.
  const std::int64_t area = (std::int64_t{b.x} - a.x) * (py - a.y) - (std::int64_t{b.y} - a.y) * (px - a.x);
  if (a.y <= py) return area <= 0 ? 1 : 0;
  return area >= 0 ? -1 : 0;
}

// Whether a point lies within sqrt(1/2) `step` of the edge from a to b: as far as its points go when both ends move by
// up to half a step in x and in y. While they stay further away, the winding number round the point cannot change.
bool near_edge(const ScreenVertex& a, const ScreenVertex& b, std::int64_t px, std::int64_t py, std::int64_t step) {
  const std::int64_t ex = std::int64_t{b.x} - a.x;
  const std::int64_t ey = std::int64_t{b.y} - a.y;
  const std::int64_t dx = px - a.x;
  const std::int64_t dy = py - a.y;
  const std::int64_t length2 = ex * ex + ey * ey;
  const std::int64_t along = ex * dx + ey * dy;
  const std::int64_t step2 = step * step;
  if (along <= 0) return 2 * (dx * dx + dy * dy) <= step2;
  if (along >= length2) {
    const std::int64_t fx = px - b.x;
    const std::int64_t fy = py - b.y;
    return 2 * (fx * fx + fy * fy) <= step2;
  }
  const Int128 area = static_cast<Int128>(ex) * dy - static_cast<Int128>(ey) * dx;
  // The distance is area / sqrt(length2). |area| < 2^50, length2 < 2^50 and step2 <= 2^8, so nothing wraps.
  return 2 * area * area <= Int128{length2} * step2;
}

bool near_outline(std::span<const ScreenVertex> outline, int x, int y, std::int64_t step) {
  for (std::size_t i = 0; i < outline.size(); ++i)
    if (near_edge(outline[i], outline[(i + 1) % outline.size()], std::int64_t{256} * x + 128,
                  std::int64_t{256} * y + 128, step))
      return true;
  return false;
}

}  // namespace

// A line further than a step of the snap outside of an outline cannot meet it, however the snap moved it.
bool Oracle::meets_line(std::span<const ScreenVertex> outline) const {
  const int centre = 256 * y_ + 128;
  bool above = false;
  bool below = false;
  for (const ScreenVertex& v : outline) {
    above = above || v.y <= centre + step();
    below = below || v.y >= centre - step();
  }
  return above && below;
}

Oracle::Oracle(const FrameGeometry& geometry, const Config& config) : g_(&geometry), config_(config) { line(0); }

void Oracle::line(int y) {
  y_ = y;
  drawn_.clear();
  for (std::uint32_t i = 0; i < g_->drawn; ++i)
    if (meets_line(g_->outline(g_->polygons[i]))) drawn_.push_back(i);
  volumes_.clear();
  for (std::uint32_t i = 0; i < g_->volumes.size(); ++i) {
    const ShadowVolume& from = g_->volumes[i];
    Volume v;
    v.index = i;
    for (const VolumeFace& f : std::span(g_->volume_faces).subspan(from.first_face, from.face_count))
      if (meets_line(g_->outline(g_->polygons[f.polygon]))) v.faces.push_back({f.polygon, f.w});
    for (const NearEdge& e : std::span(g_->near_edges).subspan(from.first_near, from.near_count))
      if (meets_line(std::array{e.from, e.to})) v.near.push_back(e);
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

// Each depth is off by (k + 1) 2^-(Z_FRAC+1) at most, k <= x, and is then rounded to a whole LSB, by 1/2 at most. If
// vertices move, a polygon shows at a pixel what it showed at most half a step away in x and in y, since the same mix
// of vertices lay there before. That changes its depth by up to (|a| + |b|) step / 512.
Oracle::Sure Oracle::surely_nearer(const ScreenPlane& a, const ScreenPlane& b, int x, Errors errors) const {
  const Int128 unit = static_cast<Int128>(1) << kPlaneFrac;
  Int128 bound = unit + 2 * (((static_cast<Int128>(x) + 1) << kPlaneFrac) >> (config_.z_frac + 1));
  if (errors == Errors::depth_and_snap) {
    const auto slope = [](const ScreenPlane& p) {
      return (p.a < 0 ? -Int128{p.a} : Int128{p.a}) + (p.b < 0 ? -Int128{p.b} : Int128{p.b});
    };
    bound += (slope(a) + slope(b)) * step() / 512 + 1;
  }
  const Int128 gap = depth(b, x, y_, config_.z_bits) - depth(a, x, y_, config_.z_bits);
  if (gap > bound) return Sure::yes;
  return gap < -bound ? Sure::no : Sure::maybe;
}

Oracle::Sure Oracle::surely_covers(std::uint32_t polygon, int x, Errors errors) const {
  const auto outline = g_->outline(g_->polygons[polygon]);
  if (errors == Errors::depth_and_snap && near_outline(outline, x, y_, step())) return Sure::maybe;
  return winding(outline, x, y_) != 0 ? Sure::yes : Sure::no;
}

int Oracle::near_cap(const Volume& v, int x) const {
  int sum = 0;
  for (const NearEdge& e : v.near)
    sum += e.w * edge_winding(e.from, e.to, std::int64_t{256} * x + 128, std::int64_t{256} * y_ + 128);
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
  for (const Volume& v : volumes_) p.shadowed = p.shadowed || in_volume(v, x, static_cast<std::uint32_t>(p.surface));
  return p;
}

bool Oracle::in_volume(const Volume& v, int x, std::uint32_t surface) const {
  const int mask = (1 << config_.dsf_bits) - 1;
  int sum = near_cap(v, x);
  for (const Face& f : v.faces) {
    const ScreenPolygon& face = g_->polygons[f.polygon];
    if (nearer(face.depth, g_->polygons[surface].depth, x)) sum += f.w * winding(g_->outline(face), x, y_);
  }
  return (sum & mask) != 0;
}

double Oracle::exact_depth(int x, std::uint32_t surface) const {
  return static_cast<double>(depth(g_->polygons[surface].depth, x, y_, config_.z_bits)) * 0x1p-24;
}

Verdict Oracle::judge_surface(int x, const OraclePixel& truth, std::int32_t seen) const {
  if (seen == truth.surface) return Verdict::right;
  if (seen < 0 || truth.surface < 0 || !covers(static_cast<std::uint32_t>(seen), x)) return Verdict::gross;
  return possible_surface(x, seen, Errors::depth) ? Verdict::near_tie : Verdict::gross;
}

Verdict Oracle::judge_shadow(int x, const OraclePixel& truth, bool seen) const {
  if (seen == truth.shadowed || truth.surface < 0) return Verdict::right;
  const PossibleShadow possible = possible_shadow(x, static_cast<std::uint32_t>(truth.surface), Errors::depth);
  return (seen ? possible.shadowed : possible.lit) ? Verdict::near_tie : Verdict::gross;
}

bool Oracle::possible_surface(int x, std::int32_t surface, Errors errors) const {
  if (surface >= 0 && surely_covers(static_cast<std::uint32_t>(surface), x, errors) == Sure::no) return false;
  for (const std::uint32_t i : drawn_) {
    if (static_cast<std::int32_t>(i) == surface || surely_covers(i, x, errors) != Sure::yes) continue;
    if (surface < 0) return false;
    const ScreenPlane& plane = g_->polygons[static_cast<std::uint32_t>(surface)].depth;
    if (surely_nearer(g_->polygons[i].depth, plane, x, errors) == Sure::yes) return false;
  }
  return true;
}

Oracle::Sure Oracle::surely_in_volume(const Volume& v, int x, std::uint32_t surface, Errors errors) const {
  const int mask = (1 << config_.dsf_bits) - 1;
  int sum = near_cap(v, x);
  if (errors == Errors::depth_and_snap)
    for (const NearEdge& e : v.near)
      if (near_edge(e.from, e.to, std::int64_t{256} * x + 128, std::int64_t{256} * y_ + 128, step()))
        return Sure::maybe;
  for (const Face& f : v.faces) {
    // The surface's own plane is the same numbers on both sides: no error can part them.
    if (f.polygon == surface) continue;
    const ScreenPolygon& face = g_->polygons[f.polygon];
    const Sure covers = surely_covers(f.polygon, x, errors);
    const Sure nearer = surely_nearer(face.depth, g_->polygons[surface].depth, x, errors);
    if (covers == Sure::no || nearer == Sure::no) continue;
    if (covers == Sure::maybe || nearer == Sure::maybe) return Sure::maybe;
    sum += f.w * winding(g_->outline(face), x, y_);
  }
  return (sum & mask) != 0 ? Sure::yes : Sure::no;
}

PossibleShadow Oracle::possible_shadow(int x, std::uint32_t surface, Errors errors) const {
  PossibleShadow possible{true, false};
  for (const Volume& v : volumes_) {
    const Sure in = surely_in_volume(v, x, surface, errors);
    possible.shadowed = possible.shadowed || in != Sure::no;
    possible.lit = possible.lit && in != Sure::yes;
  }
  return possible;
}

std::array<PossibleCount, 8> Oracle::possible_counts(int x, std::uint32_t surface, Errors errors) const {
  std::array<PossibleCount, 8> possible{};
  for (std::size_t i = 0; i < volumes_.size();) {
    // Volumes come in the order of their samples, and any of a sample's keeps it out.
    const std::uint32_t sample = g_->volumes[volumes_[i].index].sample;
    Sure in = Sure::no;
    for (; i < volumes_.size() && g_->volumes[volumes_[i].index].sample == sample; ++i)
      in = std::max(in, surely_in_volume(volumes_[i], x, surface, errors));
    PossibleCount& count = possible[g_->sample_light[sample]];
    if (in == Sure::yes) ++count.least;
    if (in != Sure::no) ++count.most;
  }
  return possible;
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
