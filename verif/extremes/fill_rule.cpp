// SPDX-License-Identifier: Apache-2.0
#include "extremes/fill_rule.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "extremes/fill_rule_checks.hpp"
#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"
#include "oracle/judge.hpp"

namespace kage::verif {
namespace {

constexpr int kCoverWidth = 80;
constexpr int kCoverHeight = 60;
constexpr int kLimit = kGuard * 256;

/// A triangle in triangles that share the points, each point in the triangle that holds it.
void strew(std::vector<Outline>& t, const std::vector<NearPoint>& points) {
  for (const NearPoint& point : points) {
    const ScreenVertex p = point.at();
    for (std::size_t i = 0; i < t.size(); ++i) {
      const Outline o = t[i];
      const auto s0 = area2(o[0], o[1], p);
      const auto s1 = area2(o[1], o[2], p);
      const auto s2 = area2(o[2], o[0], p);
      if (!((s0 > 0 && s1 > 0 && s2 > 0) || (s0 < 0 && s1 < 0 && s2 < 0))) continue;
      t[i] = {o[0], o[1], p};
      t.push_back({o[1], o[2], p});
      t.push_back({o[2], o[0], p});
      break;
    }
  }
}

}  // namespace

void NearPoint::fields(Fields& f) {
  f.number("x", x, -5000, kCoverWidth * 256 + 5000);
  f.number("y", y, -5000, kCoverHeight * 256 + 5000);
}

// ---- 1

void TriangulationCase::fields(Fields& f) {
  f.number("x0", x0, -5000, std::int64_t{256} * kCoverWidth);
  f.number("y0", y0, -5000, std::int64_t{256} * kCoverHeight);
  f.number("width", width, 1, kCoverWidth * 256 + 10'000, 256);
  f.number("height", height, 1, kCoverHeight * 256 + 10'000, 256);
  f.list("point", points, 0, 400);
}

Outcome TriangulationCase::check(const Context& context) const {
  const ScreenVertex a{x0, y0};
  const ScreenVertex b{x0, y0 + height};
  const ScreenVertex c{x0 + width, y0 + height};
  const ScreenVertex d{x0 + width, y0};
  std::vector<Outline> parts{{a, b, c}, {a, c, d}};
  std::vector<NearPoint> strewn = points;
  // Every other point on a pixel's centre.
  for (std::size_t i = 0; i < strewn.size(); i += 2)
    strewn[i].x = (strewn[i].x & ~255) + 128, strewn[i].y = (strewn[i].y & ~255) + 128;
  strew(parts, strewn);
  return parts_are_whole(parts, {a, b, c, d}, kCoverWidth, kCoverHeight, context);
}

// ---- 2

void VertexOrderCase::fields(Fields& f) {
  a.fields(f);
  b.fields(f);
  c.fields(f);
}

Outcome VertexOrderCase::check(const Context& context) const {
  Outline o{a.at(), b.at(), c.at()};
  Outcome out;
  for (int turn = 0; turn < 6; ++turn) {
    out.add(covers_what_the_oracle_says(o, kCoverWidth, kCoverHeight, context));
    std::rotate(o.begin(), o.begin() + 1, o.end());
    if (turn == 2) std::reverse(o.begin(), o.end());
  }
  return out;
}

// ---- 3

void QuadCase::fields(Fields& f) {
  a.fields(f);
  b.fields(f);
  c.fields(f);
  d.fields(f);
}

Outcome QuadCase::check(const Context& context) const {
  // A corner in each quarter about (40, 30), so that the quadrilateral is convex or at least simple.
  const auto odd = [](int v, int low, int high) { return (low + (v + 5000) % (high - low)) | 1; };
  const ScreenVertex p{odd(a.x, 0, 9000), odd(a.y, 0, 7000)};
  const ScreenVertex q{odd(b.x, 0, 9000), odd(b.y, 8500, 15000)};
  const ScreenVertex r{odd(c.x, 11500, 20000), odd(c.y, 8500, 15000)};
  const ScreenVertex s{odd(d.x, 11500, 20000), odd(d.y, 0, 7000)};
  Outcome o;
  for (const auto& [first, second] : {std::pair<Outline, Outline>{{p, q, r}, {p, r, s}}, {{p, q, s}, {q, r, s}}}) {
    // A diagonal outside a quadrilateral that is not convex turns one half over.
    if ((area2(first[0], first[1], first[2]) > 0) != (area2(second[0], second[1], second[2]) > 0)) continue;
    o.add(parts_are_whole({first, second}, {p, q, r, s}, kCoverWidth, kCoverHeight, context));
  }
  return o;
}

// ---- 4

void CentresCase::fields(Fields& f) {
  f.number("x", x, 0, kCoverWidth - 1, 40);
  f.number("y", y, 0, kCoverHeight - 1, 30);
  f.number("r", r, 1, 40);
  f.number("p", p, -r, r);
  f.flag("down", down);
}

Outcome CentresCase::check(const Context& context) const {
  const ScreenVertex m{x * 256 + 128, y * 256 + 128};
  const ScreenVertex nw{m.x - r * 256, m.y - r * 256};
  const ScreenVertex ne{m.x + r * 256, m.y - r * 256};
  const ScreenVertex se{m.x + r * 256, m.y + r * 256};
  const ScreenVertex sw{m.x - r * 256, m.y + r * 256};
  if (down) {
    const ScreenVertex top{m.x - p * 256, m.y - r * 256};
    const ScreenVertex bottom{m.x + p * 256, m.y + r * 256};
    return parts_are_whole({{nw, sw, bottom, top}, {top, bottom, se, ne}}, {nw, sw, se, ne}, kCoverWidth, kCoverHeight,
                           context);
  }
  const ScreenVertex left{m.x - r * 256, m.y - p * 256};
  const ScreenVertex right{m.x + r * 256, m.y + p * 256};
  return parts_are_whole({{nw, left, right, ne}, {left, sw, se, right}}, {nw, sw, se, ne}, kCoverWidth, kCoverHeight,
                         context);
}

// ---- 5

void FanCase::Rim::fields(Fields& f) { f.number("at", at, 0, 47'999); }

void FanCase::fields(Fields& f) {
  f.number("x", x, 0, kCoverWidth - 1, 40);
  f.number("y", y, 0, kCoverHeight - 1, 30);
  f.number("half", half, 300, 20'000, 6000);
  f.list("rim", rim, 3, 1000);
}

Outcome FanCase::check(const Context& context) const {
  const ScreenVertex hub{x * 256 + 128, y * 256 + 128};
  std::vector<int> places;
  for (const Rim& r : rim) places.push_back(r.at);
  for (int corner = 0; corner < 4; ++corner) places.push_back(12'000 * corner);  // so that the rim is the square
  std::sort(places.begin(), places.end());
  Outline outline;
  for (const int at : places) {
    const int along = at % 12'000 * (2 * half) / 12'000 - half;
    const ScreenVertex p = at < 12'000   ? ScreenVertex{hub.x + along, hub.y - half}
                           : at < 24'000 ? ScreenVertex{hub.x + half, hub.y + along}
                           : at < 36'000 ? ScreenVertex{hub.x - along, hub.y + half}
                                         : ScreenVertex{hub.x - half, hub.y - along};
    if (outline.empty() || !(outline.back() == p)) outline.push_back(p);
  }
  std::vector<Outline> fan;
  for (std::size_t i = 0; i < outline.size(); ++i) fan.push_back({hub, outline[i], outline[(i + 1) % outline.size()]});
  const Outline square{{hub.x - half, hub.y - half},
                       {hub.x + half, hub.y - half},
                       {hub.x + half, hub.y + half},
                       {hub.x - half, hub.y + half}};
  return parts_are_whole(fan, square, kCoverWidth, kCoverHeight, context);
}

// ---- 6

void SliverCase::fields(Fields& f) {
  f.flag("upright", upright);
  f.flag("four", four);
  f.number("near_end", near_end, 0, std::int64_t{256} * 700);
  f.number("far_end", far_end, 0, std::int64_t{256} * 700);
  f.number("from", from, 0, std::int64_t{256} * (upright ? kCoverWidth : kCoverHeight));
  f.number("to", to, 0, std::int64_t{256} * (upright ? kCoverWidth : kCoverHeight));
}

Outcome SliverCase::check(const Context& context) const {
  const auto at = [this](int along, int across) {
    return upright ? ScreenVertex{across, along} : ScreenVertex{along, across};
  };
  const ScreenVertex a = at(-kLimit + near_end, from);
  const ScreenVertex b = at(kLimit - far_end, to);
  const ScreenVertex c = at(kLimit - far_end, to + 1);
  Outline o{a, b, c};
  if (four) o = {a, at(-kLimit + near_end, from + 1), c, b};
  return covers_what_the_oracle_says(o, kCoverWidth, kCoverHeight, context);
}

// ---- 7

void FlatCase::Along::fields(Fields& f) { f.number("at", at, -100, 100); }

void FlatCase::fields(Fields& f) {
  f.number("x", x, 0, std::int64_t{256} * kCoverWidth);
  f.number("y", y, 0, std::int64_t{256} * kCoverHeight);
  f.number("dx", dx, -256, 256, 1);
  f.number("dy", dy, -256, 256);
  f.list("corner", corners, 3, 8);
}

Outcome FlatCase::check(const Context& context) const {
  Outline flat;
  for (const Along& a : corners) flat.push_back({x + a.at * dx, y + a.at * dy});
  return draws_nothing(flat, kCoverWidth, kCoverHeight, context);
}

// ---- 8

void LevelCase::fields(Fields& f) {
  f.number("line", line, 0, kCoverHeight - 1);
  f.number("above", above, -1, 2);
  f.flag("falling", falling);
  f.number("third", third, -kLimit, kLimit);
  f.flag("below", below);
}

Outcome LevelCase::check(const Context& context) const {
  const int y = line * 256 + 128 - above;
  const int left = falling ? y : y + 1;
  const int right = falling ? y + 1 : y;
  return covers_what_the_oracle_says({{-kLimit, left}, {kLimit, right}, {third, below ? 50 * 256 : 0}}, kCoverWidth,
                                     kCoverHeight, context);
}

// ---- 9

void GuardCase::Corner::fields(Fields& f) {
  static constexpr std::array kinds{"free", "limit", "-limit", "limit-1", "1-limit"};
  f.choice("kind_x", kind_x, kinds);
  f.number("x", x, -kLimit, kLimit);
  f.choice("kind_y", kind_y, kinds);
  f.number("y", y, -kLimit, kLimit);
}

void GuardCase::fields(Fields& f) {
  a.fields(f);
  b.fields(f);
  c.fields(f);
  f.choice("past", past, std::array{"none", "limit+1", "-limit-1", "2^15", "-2^15", "2^15+1", "most", "least"});
  f.number("which", which, 0, 5);
}

Outcome GuardCase::check(const Context& context) const {
  Outline outline;
  for (const Corner* corner : {&a, &b, &c}) {
    const auto place = [](int kind, int free) {
      return std::array{free, kLimit, -kLimit, kLimit - 1, 1 - kLimit}[static_cast<std::size_t>(kind)];
    };
    outline.push_back({place(corner->kind_x, corner->x), place(corner->kind_y, corner->y)});
  }
  if (past > 0) {
    constexpr int kEdge = (1 << 15) * 256;
    ScreenVertex& v = outline[static_cast<std::size_t>(which / 2)];
    (which % 2 == 0 ? v.x : v.y) = std::array{
        0, kLimit + 1, -kLimit - 1, kEdge, -kEdge, kEdge + 1, INT32_MAX, INT32_MIN}[static_cast<std::size_t>(past)];
  }
  Outcome o;
  FrameBuilder frame(40, 30);
  frame.add(outline, plane(1000));
  std::vector<std::uint32_t> words;
  bool refused = false;
  try {
    make_frame(frame.frame(), Config{}, 0, words, {.threads = 1});
    check_frame(Config{}, words, "front end", 0);
  } catch (const Error&) {
    refused = true;
  }
  if (refused != (past > 0))
    o.fail(refused ? "corners within the guard band are refused" : "a corner past the guard band is not refused");
  if (refused && !words.empty()) o.fail("words were written before it was refused");
  if (past == 0) o.add(covers_what_the_oracle_says(outline, 40, 30, context));
  o.items = 1;
  return o;
}

// ---- 11

void MovedCase::Face::fields(Fields& f) {
  for (int* x : {&ax, &bx, &cx})
    f.number(x == &ax ? "ax" : x == &bx ? "bx" : "cx", *x, std::int64_t{256} * 16, std::int64_t{256} * 64);
  for (int* y : {&ay, &by, &cy})
    f.number(y == &ay ? "ay" : y == &by ? "by" : "cy", *y, std::int64_t{256} * 11, std::int64_t{256} * 49);
  f.real("z", z, 1e5, 1.6e7);
  f.real("a", a, -1e4, 1e4);
  f.real("b", b, -1e4, 1e4);
}

void MovedCase::fields(Fields& f) {
  f.number("dx", dx, -15, 15);
  f.number("dy", dy, -10, 10);
  f.list("face", faces, 1, 20);
}

Outcome MovedCase::check(const Context& context) const {
  FrameBuilder here(kCoverWidth, kCoverHeight);
  FrameBuilder there(kCoverWidth, kCoverHeight);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i];
    const Outline at{{face.ax, face.ay}, {face.bx, face.by}, {face.cx, face.cy}};
    Outline moved = at;
    for (ScreenVertex& v : moved) v.x += 256 * dx, v.y += 256 * dy;
    ScreenPlane p = plane(face.z, face.a, face.b, 40, 30);
    const std::array<std::uint8_t, 3> color{static_cast<std::uint8_t>(10 * i), 7, static_cast<std::uint8_t>(i)};
    here.add(at, p, color);
    p.x0 += dx;
    p.y0 += dy;
    there.add(moved, p, color);
  }
  const auto a = draw(here.frame(), Config{});
  auto b = draw(there.frame(), Config{});
  context.spoil(b);
  Outcome o;
  for (int y = 0; y < kCoverHeight; ++y)
    for (int x = 0; x < kCoverWidth; ++x) {
      const int fx = x - dx;
      const int fy = y - dy;
      const bool inside = fx >= 0 && fx < kCoverWidth && fy >= 0 && fy < kCoverHeight;
      const std::uint32_t expected = inside ? a[pixel_index(fx, fy, kCoverWidth)] : 0U;
      if (b[pixel_index(x, y, kCoverWidth)] != expected)
        o.fail(fmt::format("pixel ({}, {}) is {:06x}, not {:06x}", x, y, b[pixel_index(x, y, kCoverWidth)], expected));
    }
  o.items = b.size();
  const Judgement j = judge(there.frame(), Config{});
  o.pixels = j.pixels;
  if (!j.good()) o.fail(j.text());
  return o;
}

// ---- 13

void JointsCase::Span::fields(Fields& f) { f.number("pixels", pixels, 0, kCoverWidth); }

void JointsCase::fields(Fields& f) { f.list("span", spans, 1, 60); }

Outcome JointsCase::check(const Context& context) const {
  const Config config;
  std::vector<std::uint32_t> words;
  TokenWriter w(config, words);
  w.header({kCoverWidth, 1, 0, 0});
  std::vector<std::uint8_t> expected(std::size_t{kCoverWidth} * 3);
  int x = 0;
  int color = 0;
  for (const Span& span : spans) {
    const int to = std::min(kCoverWidth, x + span.pixels);
    ++color;
    SpanToken s;
    s.xl = x;
    s.xr = context.injected(Injection::wide_span) && to - x >= 3 ? std::min(kCoverWidth, to + 1) : to;
    s.z = std::int64_t{1000 - color} << config.z_frac;
    s.color = {color, color, color};
    w.op(s);
    std::fill(expected.begin() + std::ptrdiff_t{3} * x, expected.begin() + std::ptrdiff_t{3} * to,
              static_cast<std::uint8_t>(color));
    x = to;
  }
  w.eol(0);
  w.end();
  std::vector<std::uint8_t> out;
  const FrameStatus status =
      GoldenCore(config).frame(words, [&out](int, std::span<const std::uint8_t> p) { out.assign(p.begin(), p.end()); });
  Outcome o;
  if (status.error != ErrorCode::NONE) o.fail("the golden core refuses the frame");
  if (out != expected) o.fail("a pixel is not that of the one span that holds it");
  o.pixels = kCoverWidth;
  return o;
}

void add_fill_rule_families(Families& to) {
  add_family<TriangulationCase>(to, {1, "1", "a rectangle in triangles: each pixel has one owner"});
  add_family<VertexOrderCase>(to, {2, "2", "a triangle's corners in any order and winding"});
  add_family<QuadCase>(to, {3, "3", "a quadrilateral cut along either diagonal, odd subpixels"});
  add_family<CentresCase>(to, {4, "4", "edges from pixel centre to pixel centre"});
  add_family<FanCase>(to, {5, "5", "a fan of triangles round a pixel centre"});
  add_family<SliverCase>(to, {6, "6", "slivers a subpixel wide, as long as the guard band"});
  add_family<FlatCase>(to, {7, "7", "polygons without area"});
  add_family<LevelCase>(to, {8, "8", "edges a subpixel high, as long as the guard band"});
  add_family<GuardCase>(to, {9, "9", "corners at the guard band and past it"});
  add_family<MovedCase>(to, {11, "11", "a frame moved by whole pixels"});
  add_family<JointsCase>(to, {13, "13", "spans of no, one and all pixels, joints anywhere"});
}

}  // namespace kage::verif
