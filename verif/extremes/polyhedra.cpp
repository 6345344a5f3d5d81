// SPDX-License-Identifier: Apache-2.0
#include "extremes/polyhedra.hpp"

#include <cmath>

#include "extremes/tree_frames.hpp"
#include "oracle/judge.hpp"

namespace kage::verif {
namespace {

constexpr int kPolyhedronWidth = 96;
constexpr int kPolyhedronHeight = 72;

/// The frame's picture by spans is the oracle's, and by segments the same with any number of units.
Outcome same_and_right(const SceneFrame& f, Config config, int width, int height, const Context& context,
                       const Look& look = {}) {
  Outcome o;
  for (const SegmentCount& c :
       either_way_counts(f, config, width, height, look, [&](auto& pixels) { context.spoil(pixels); })) {
    if (!c.wrong.empty()) o.fail(c.wrong);
    o.items += static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  }
  config.units = 8;
  const Judgement j = judge(make_geometry(f, config, width, height, {.look = look}), config);
  o.pixels = j.pixels;
  if (!j.good()) o.fail(j.text());
  return o;
}

}  // namespace

// ---- 31

void BlockCase::fields(Fields& f) {
  f.number("left", left, -20, kPolyhedronWidth + 4, 30);
  f.number("top", top, -20, kPolyhedronHeight + 4, 20);
  f.number("left_part", left_part, 0, 255);
  f.number("top_part", top_part, 0, 255);
  f.number("width", width, 1, std::int64_t{256} * 140, 256);
  f.number("height", height, 1, std::int64_t{256} * 110, 256);
  f.number("side", side, 0, 10);
  f.flag("turned", turned);
  turn.fields(f);
}

Outcome BlockCase::check(const Context& context) const {
  const double x0 = left + left_part / 256.0;
  const double y0 = top + top_part / 256.0;
  const double x1 = x0 + width / 256.0;
  const double y1 = y0 + height / 256.0;
  Solid s = box_solid();
  const Turn t = turned ? turn.turn() : Turn{};
  for (glm::dvec3& v : s.vertices) {
    const double right = v.x < 0 ? x0 : v.z < 0 ? x1 + side : x1;
    const glm::dvec3 middle((x0 + x1) / 2, (y0 + y1) / 2, 0);
    const glm::dvec3 at(right, v.y < 0 ? y1 : y0, v.z);
    const glm::dvec3 p = turned ? middle + t(at - middle) : at;
    v = {p.x - kPolyhedronWidth / 2.0, kPolyhedronHeight / 2.0 - p.y, p.z};
  }
  SceneFrame f;
  add_solid(f, s, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.2});
  look_at(f.camera, {0, 0, 300}, {0, 0, 0});
  f.camera.perspective = false;
  f.camera.half_height = kPolyhedronHeight / 2.0;
  Outcome o = same_and_right(f, Config{}, kPolyhedronWidth, kPolyhedronHeight, context);
  if (turned || side > 0) return o;
  // Upright and facing the eye it shows the pixels whose centres it holds: the upper and left edges count.
  const auto centres = [](double from, double to, int size) {
    const double first = std::max(0.0, std::ceil(from - 0.5));
    return std::max(0.0, std::min<double>(size, std::ceil(to - 0.5)) - first);
  };
  const double expected = centres(x0, x1, kPolyhedronWidth) * centres(y0, y1, kPolyhedronHeight);
  for (const SegmentCount& c : either_way_counts(f, Config{}, kPolyhedronWidth, kPolyhedronHeight))
    if (c.by_segments + c.unseen == 1 && static_cast<double>(c.face_pixels) != expected)
      o.fail(fmt::format("{} units: {} pixels, not {}", c.units, c.face_pixels, expected));
  return o;
}

// ---- 32

void CapacityCase::fields(Fields& f) {
  f.number("face_bits", face_bits, 2, 6, 3);
  f.number("seg_bits", seg_bits, 2, 10, 5);
  f.number("dx_bits", dx_bits, 2, 11, 9);
  f.number("width", width, 1, 1100, 96);
  f.real("stretch", wide, 1, 100, 1);
  solid.fields(f);
  view.fields(f);
}

Outcome CapacityCase::check(const Context& context) const {
  Config c;
  c.max_width = 2047;
  c.face_bits = face_bits;
  c.seg_bits = seg_bits;
  c.dx_bits = dx_bits;
  SceneFrame f;
  add_solid(f, solid.solid(), {0, 0, 0}, glm::dvec3(solid.wide * wide, solid.high, solid.deep), solid.turn.turn(),
            {1, 0.5, 0.2});
  view.apply_to(f.camera);
  constexpr int kLines = 24;
  Outcome o = same_and_right(f, c, width, kLines, context);
  if (!o.wrong.empty()) return o;
  c.units = 1;
  const FrameGeometry g = make_geometry(f, c, width, kLines);
  const Picture p = picture(g, c);
  if (!g.polyhedra.empty() && p.unseen() == 0) {
    // One table holds all its faces, but for the number that is kept for nothing; else it goes by spans.
    const bool fits = static_cast<int>(g.polyhedra[0].polygon_count) < 1 << face_bits;
    if (!fits && p.by_segments() != 0) o.fail("more faces than FACE_BITS hold go by segments");
  }
  // The next segment of a run that is split goes on with the very sum that the run has reached.
  std::vector<std::int64_t> steps;
  each_token(p.words, c, Kind::FACE, [&](const Token& t, std::size_t) { steps.push_back(t.segment.dz); });
  if (p.count(Kind::TREE) > 0) {
    const auto units = segments_of(p, c);
    for (const auto& line : units[0])
      for (std::size_t i = 1; i < line.size(); ++i) {
        const SegmentToken& s = line[i - 1];
        if (line[i].face != s.face || s.face == (1 << c.face_bits) - 1) continue;
        ++o.items;
        if (line[i].z != s.z + s.dx * steps.at(static_cast<std::size_t>(s.face)))
          o.fail("a split run does not go on with the depth that it has reached");
      }
  }
  return o;
}

// ---- 33

void UnitsCase::fields(Fields& f) {
  f.number("copies", copies, 0, 5);
  scene.fields(f, 1, 12);
}

Outcome UnitsCase::check(const Context& context) const {
  SceneCase all = scene;
  all.convex = true;
  SceneFrame f = all.frame();
  for (int i = 0; i < copies; ++i) scene.solids[0].add_to(f, static_cast<std::size_t>(i) + 3);
  return same_and_right(f, Config{}, kPolyhedronWidth, kPolyhedronHeight, context, scene.look());
}

// ---- 34

void ManyCase::fields(Fields& f) {
  f.number("count", count, 1, 40, 1);
  f.number("order_bits", order_bits, 1, 8, 8);
  f.real("apart_x", apart_x, -1, 1);
  f.real("apart_y", apart_y, -1, 1);
  f.real("apart_z", apart_z, -0.5, 0.5, -0.25);
}

Outcome ManyCase::check(const Context& context) const {
  SceneFrame f;
  for (int i = 0; i < count; ++i) {
    const double at = i - (count - 1) / 2.0;
    add_solid(f, box_solid(), glm::dvec3(apart_x, apart_y, apart_z) * at, glm::dvec3(0.3), Turn{}, {1, 0.02 * i, 0.2});
  }
  look_at(f.camera, {0, 0, 12}, {0, 0, 0});
  Config c;
  c.order_bits = order_bits;
  Outcome o = same_and_right(f, c, kPolyhedronWidth, kPolyhedronHeight, context);
  for (const SegmentCount& n : either_way_counts(f, c, kPolyhedronWidth, kPolyhedronHeight))
    if (n.by_segments > 1 << order_bits) o.fail("more polyhedra by segments than ORDER_BITS can number");
  return o;
}

void add_polyhedra_families(Families& to) {
  add_family<BlockCase>(to, {31, "31", "edges on lines and centres, faces edge-on, bodies leaving the screen"});
  add_family<CapacityCase>(to, {32, "32", "as many faces, segments and pixels as fit, and more"});
  add_family<UnitsCase>(to, {33, "33", "any polyhedra and copies, with any number of units"});
  add_family<ManyCase>(to, {34, "34", "more polyhedra than units or indices"});
}

}  // namespace kage::verif
