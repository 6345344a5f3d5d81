// SPDX-License-Identifier: Apache-2.0
#include "frontend/polygon_shape.hpp"

#include <limits>

#include "number/bits.hpp"
#include "polygon/active_polygon.hpp"

namespace kage {
namespace {

PolygonToken plane_token(const ScreenPlane& plane, int first, int bits) {
  PolygonToken t;
  t.value = sign_extend(static_cast<std::uint64_t>(value_at(plane, 0, first - 1)), bits);
  t.right = plane.a;
  t.down = plane.b;
  return t;
}

/// `v`, or the most that 16 bits hold: that many words already say that spans take fewer.
std::uint16_t at_most(std::size_t v) {
  return static_cast<std::uint16_t>(std::min<std::size_t>(v, std::numeric_limits<std::uint16_t>::max()));
}

}  // namespace

PolygonToken depth_of(const Config& config, const ScreenPolygon& p, int first) {
  return plane_token(p.depth, first, derived::plane_bits(config));
}

PolygonToken gradient_of(const FrameGeometry& g, const Config& config, const ScreenPolygon& p, int first, int channel,
                         std::size_t pass) {
  ScreenPlane plane = color_plane(g, p, static_cast<std::size_t>(channel), pass);
  if (p.light_planes >= 0)
    plane.c += SpanSetup::color(config, level_bits(config, p, pass)).half() - SpanSetup::color(config, 8).half();
  PolygonToken t = plane_token(plane, first, kColorPlaneBits);
  t.channel = channel;
  return t;
}

PolygonShape ShapeFinder::find(const ScreenPolygon& p, bool drawn) {
  PolygonShape shape;
  const bool color = drawn && config_->smooth != 0;
  found_.clear();
  bool split = false;
  spans_.each(p, 0, g_->height, [&](int y, SpanToken& s, int winding) {
    split = split || (!found_.empty() && found_.back().y == y);
    found_.push_back({y, s, winding});
  });
  if (found_.empty()) return shape;
  shape.spans = static_cast<std::uint32_t>(found_.size());
  shape.first = static_cast<std::uint16_t>(found_.front().y);
  shape.last = static_cast<std::uint16_t>(found_.back().y);
  const auto both = [&](PolygonWay way) {
    shape.as_face = shape.as_drawn = way;
    return shape;
  };
  if (split || !two_crossings(p, shape)) return both(PolygonWay::crossings);
  if (!fits(p.depth, derived::plane_bits(*config_))) return both(PolygonWay::wide);
  both(PolygonWay::polygon);
  find_edges(p, shape);
  const auto color_fits = [&](std::size_t pass) {
    bool all = true;
    for (std::size_t c = 0; c < static_cast<std::size_t>(config_->channels); ++c)
      all = all && fits(color_plane(*g_, p, c, pass), kColorPlaneBits);
    return all;
  };
  const bool whole = color && p.shade_cut < 0;
  const std::size_t passes = whole && p.light_planes >= 0 ? g_->passes.size() : 0;
  bool narrow = !color || color_fits(0);
  compare(p, shape, whole && narrow ? std::optional<std::size_t>(0) : std::nullopt);
  for (std::size_t pass = 1; pass <= passes && narrow && shape.as_drawn == PolygonWay::polygon; ++pass) {
    narrow = color_fits(pass);
    if (narrow) compare(p, shape, pass);
  }
  if (shape.as_drawn != PolygonWay::polygon) return shape;
  if (color && !whole)
    shape.as_drawn = PolygonWay::cut;
  else if (!narrow)
    shape.as_drawn = PolygonWay::wide;
  return shape;
}

// Between its first line and its last, where it has spans, a closed outline crosses each line at least twice; so the
// sum over all edges tells whether it does so just twice everywhere.
bool ShapeFinder::two_crossings(const ScreenPolygon& p, PolygonShape& shape) const {
  const auto outline = g_->outline(p);
  std::int64_t sum = 0;
  int end = std::numeric_limits<std::uint16_t>::max();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const LineRange lines = lines_of(outline[i], outline[i + 1 == outline.size() ? 0 : i + 1]);
    const int from = std::max<int>(lines.first, shape.first);
    const int to = std::min<int>(lines.end, shape.last + 1);
    if (from < to) sum += to - from;
    if (lines.first <= shape.last && shape.last < lines.end) end = std::min(end, lines.end);
  }
  shape.end = static_cast<std::uint16_t>(end);
  return sum == 2 * std::int64_t{shape.lines()};
}

bool ShapeFinder::fits(const ScreenPlane& plane, int bits) const {
  const Field field{0, static_cast<std::uint8_t>(bits), true};
  return beyond(plane.a, field) == 0 && beyond(plane.b, field) == 0;
}

void ShapeFinder::find_edges(const ScreenPolygon& p, PolygonShape& shape) {
  edges_.clear();
  each_edge(g_->outline(p), shape, shape.first, shape.last + 1, [&](int y, const PolygonToken& edge) {
    edges_.push_back({y, edge});
  });
  std::stable_sort(edges_.begin(), edges_.end(), [](const Begin& a, const Begin& b) { return a.y < b.y; });
  const auto words = [this](Kind k) { return std::size_t{layout_.words[static_cast<std::size_t>(k)]}; };
  std::size_t more = 0;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i].y == shape.first) continue;
    more += words(Kind::EDGE) + (edges_[i].y == edges_[i - 1].y ? 0 : words(Kind::AT));
  }
  shape.words = at_most(more);
}

// Compares range and depth, or with a pass its colour, too.
void ShapeFinder::compare(const ScreenPolygon& p, PolygonShape& shape, std::optional<std::size_t> pass) {
  Token t;
  t.polygon = depth_of(*config_, p, shape.first);
  if (config_->dsf_bits > 0) t.span.w = 1;
  for (std::size_t c = 0; c < static_cast<std::size_t>(config_->channels); ++c) t.span.color[c] = p.color[c];
  // In the volumes' layer a polygon has no colour.
  PolygonToken place;
  place.layer = static_cast<int>(pass ? Layer::opaque : Layer::volumes);
  ActivePolygon active(*config_, Place(place, 0), t);
  for (int c = 0; pass && has_color_planes(p) && c < config_->channels; ++c)
    active.color[static_cast<std::size_t>(c)] = WalkedPlane(gradient_of(*g_, *config_, p, shape.first, c, *pass));
  auto edge = edges_.begin();
  auto next = found_.begin();
  const int end = std::min<int>(shape.end, g_->height);
  for (int y = shape.first; y < end; ++y, active.next()) {
    for (; edge != edges_.end() && edge->y == y; ++edge)
      active.set_edge(edge->edge, ActivePolygon::edge_at(edge->edge, y));
    const SpanToken made = active.span(*config_, g_->width);
    const bool any = next != found_.end() && next->y == y;
    if (!any && made.xl == made.xr) continue;
    const auto same = [&](const SpanToken& s) {
      return made.xl == s.xl && made.xr == s.xr && made.z == s.z && made.dz == s.dz &&
             (config_->dsf_bits == 0 || made.w == next->winding);
    };
    if (!any || !same(next->span)) {
      shape.as_face = shape.as_drawn = PolygonWay::rounded;
      return;
    }
    if (pass) {
      SpanToken s = next->span;
      spans_.paint(p, y, *pass, s);
      if (made.color != s.color || made.dcolor != s.dcolor) shape.as_drawn = PolygonWay::rounded;
    }
    ++next;
  }
  if (active.end != shape.end || next != found_.end()) shape.as_face = shape.as_drawn = PolygonWay::rounded;
}

}  // namespace kage
