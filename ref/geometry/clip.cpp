// SPDX-License-Identifier: Apache-2.0
#include "geometry/clip.hpp"

namespace kage {
namespace {

enum class GuardSide { y_low, y_high, x_low, x_high };

constexpr double kLimit = kGuard;

double guard_distance(const ClipPoint& p, GuardSide side) {
  switch (side) {
    case GuardSide::x_low:
      return p.sx + kLimit * p.q;
    case GuardSide::x_high:
      return kLimit * p.q - p.sx;
    case GuardSide::y_low:
      return p.sy + kLimit * p.q;
    default:
      return kLimit * p.q - p.sy;
  }
}

ClipPoint between(const ClipPoint& in, const ClipPoint& out, double d_in, double d_out) {
  const double t = d_in / (d_in - d_out);
  return {in.sx + t * (out.sx - in.sx), in.sy + t * (out.sy - in.sy), in.q + t * (out.q - in.q),
          in.w + t * (out.w - in.w), in.color + t * (out.color - in.color)};
}

// Cut at distance `at`, the plane between in and out.
ClipPoint cut_at(const ClipPoint& in, const ClipPoint& out, double at) {
  ClipPoint p = between(in, out, in.w - at, out.w - at);
  if (in.q == in.w && out.q == out.w) p.q = at;  // perspective: exactly on the plane
  p.w = at;
  return p;
}

ClipPoint cut_guard(const ClipPoint& in, const ClipPoint& out, GuardSide side) {
  ClipPoint p = between(in, out, guard_distance(in, side), guard_distance(out, side));
  switch (side) {  // exactly on the border
    case GuardSide::x_low:
      p.sx = -kLimit * p.q;
      break;
    case GuardSide::x_high:
      p.sx = kLimit * p.q;
      break;
    case GuardSide::y_low:
      p.sy = -kLimit * p.q;
      break;
    case GuardSide::y_high:
      p.sy = kLimit * p.q;
      break;
  }
  return p;
}

// Sutherland-Hodgman against one plane. on_leave and on_enter see each new vertex.
template <class Distance, class Cut, class Leave, class Enter>
void clip_plane(std::vector<ClipPoint>& polygon, std::vector<ClipPoint>& buffer, Distance distance, Cut cut,
                Leave on_leave, Enter on_enter) {
  const std::size_t n = polygon.size();
  bool all_in = true;
  for (const ClipPoint& p : polygon) all_in = all_in && distance(p) >= 0;
  if (all_in) return;
  buffer.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const ClipPoint& a = polygon[i];
    const ClipPoint& b = polygon[i + 1 == n ? 0 : i + 1];
    const bool a_in = distance(a) >= 0;
    const bool b_in = distance(b) >= 0;
    if (a_in) buffer.push_back(a);
    if (a_in && !b_in) {
      buffer.push_back(cut(a, b));
      on_leave(buffer.back());
    } else if (!a_in && b_in) {
      buffer.push_back(cut(b, a));
      on_enter(buffer.back());
    }
  }
  polygon.swap(buffer);
}

// Cuts the edge a-b down to its part inside; false if no part is.
bool clip_edge(ClipPoint& a, ClipPoint& b, GuardSide side) {
  const bool a_in = guard_distance(a, side) >= 0;
  const bool b_in = guard_distance(b, side) >= 0;
  if (a_in && !b_in) b = cut_guard(a, b, side);
  if (!a_in && b_in) a = cut_guard(b, a, side);
  return a_in || b_in;
}

ScreenVertex snap_onto(const ClipPoint& p, GuardSide side, int sub_bits) {
  ScreenVertex v;
  v.x = (side == GuardSide::x_low ? -kGuard : kGuard) * 256;
  ClipPoint at_q = p;
  at_q.sx = 0;  // x may be out of range by far; only y counts
  v.y = snap(at_q, sub_bits).y;
  return v;
}

}  // namespace

void Clipper::clip(std::vector<ClipPoint>& polygon, std::vector<NearCut>* cuts, bool at_far) {
  std::vector<ClipPoint> leaves;
  std::vector<ClipPoint> enters;
  bool enter_first = false;
  clip_plane(
      polygon, buffer_, [this](const ClipPoint& p) { return p.w - near_; },
      [this](const ClipPoint& in, const ClipPoint& out) { return cut_at(in, out, near_); },
      [&](const ClipPoint& p) { leaves.push_back(p); },
      [&](const ClipPoint& p) {
        if (leaves.empty()) enter_first = true;
        enters.push_back(p);
      });
  if (cuts != nullptr)
    for (std::size_t i = 0; i < leaves.size(); ++i)
      cuts->push_back({leaves[i], enters[(i + (enter_first ? 1 : 0)) % enters.size()]});
  const auto ignore = [](const ClipPoint&) {};
  if (at_far)
    clip_plane(
        polygon, buffer_, [this](const ClipPoint& p) { return far_ - p.w; },
        [this](const ClipPoint& in, const ClipPoint& out) { return cut_at(in, out, far_); }, ignore, ignore);
  for (const GuardSide side : {GuardSide::y_low, GuardSide::y_high, GuardSide::x_low, GuardSide::x_high})
    clip_plane(
        polygon, buffer_, [side](const ClipPoint& p) { return guard_distance(p, side); },
        [side](const ClipPoint& in, const ClipPoint& out) { return cut_guard(in, out, side); }, ignore, ignore);
  if (polygon.size() < 3) polygon.clear();
}

bool Clipper::keeps(const ClipPoint& p) const {
  // Written as clip() asks, so that a vertex that is not a number is not kept.
  if (!(p.w - near_ >= 0)) return false;
  for (const GuardSide side : {GuardSide::y_low, GuardSide::y_high, GuardSide::x_low, GuardSide::x_high})
    if (!(guard_distance(p, side) >= 0)) return false;
  return true;
}

void Clipper::snap_cut(const NearCut& cut, std::int32_t w, std::vector<NearEdge>& edges) const {
  const auto add = [&](ScreenVertex from, ScreenVertex to) {
    if (from.y != to.y) edges.push_back({to, from, w});  // level edges bound nothing
  };
  ClipPoint a = cut.from;
  ClipPoint b = cut.to;
  if (!clip_edge(a, b, GuardSide::y_low) || !clip_edge(a, b, GuardSide::y_high)) return;
  for (const GuardSide side : {GuardSide::x_low, GuardSide::x_high}) {
    const bool a_in = guard_distance(a, side) >= 0;
    const bool b_in = guard_distance(b, side) >= 0;
    if (!a_in && !b_in) {
      add(snap_onto(a, side, sub_bits_), snap_onto(b, side, sub_bits_));
      return;
    }
    if (a_in && !b_in) {
      const ClipPoint g = cut_guard(a, b, side);
      add(snap_onto(g, side, sub_bits_), snap_onto(b, side, sub_bits_));
      b = g;
    } else if (!a_in) {
      const ClipPoint g = cut_guard(b, a, side);
      add(snap_onto(a, side, sub_bits_), snap_onto(g, side, sub_bits_));
      a = g;
    }
  }
  add(snap(a, sub_bits_), snap(b, sub_bits_));
}

}  // namespace kage
