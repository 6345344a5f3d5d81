// SPDX-License-Identifier: Apache-2.0
// Faces of one polyhedron that overlap: only the snap makes them, by a pixel here and there, so they are made by hand.
// Each pixel is the nearest face's, on a tie the first one's, as if the faces were drawn as spans.
#include <array>
#include <cmath>

#include "extremes/screen.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "test/support/tree_frames.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 40;
constexpr int kHeight = 12;

/// A polyhedron of all polygons so far, none of which shares an edge.
void make_polyhedron(FrameGeometry& g) {
  for (std::uint32_t i = 0; i < g.drawn; ++i) {
    const auto outline = g.outline(g.polygons[i]);
    for (std::size_t k = 0; k < outline.size(); ++k)
      g.polyhedron_edges.push_back({outline[k], outline[(k + 1) % outline.size()], i, PolyhedronEdge::kNoPolygon});
  }
  g.polyhedra.push_back({0, 0, g.drawn, 0, static_cast<std::uint32_t>(g.polyhedron_edges.size())});
}

/// Triangles and quadrangles anywhere, of either winding, crossing themselves at times; depths from few values.
FrameBuilder random_faces(Random& random, Hits& hits) {
  FrameBuilder b(kWidth, kHeight);
  const int faces = random.in(2, 6);
  const bool flat = random.chance(0.3);
  for (int i = 0; i < faces; ++i) {
    Outline o(static_cast<std::size_t>(random.in(3, 4)));
    for (ScreenVertex& v : o) v = {random.in(-256, 256 * (kWidth + 1)), random.in(-256, 256 * (kHeight + 1))};
    const double slope = flat ? 0 : random.in(-3, 3);
    const double down = flat ? 0 : random.in(-1, 1);
    b.add(o, plane(500 + random.in(0, 2), slope, down, kWidth / 2, kHeight / 2),
          {static_cast<std::uint8_t>(40 * (i + 1)), 0, 0});
    hits.add(o);
  }
  return b;
}

}  // namespace

TEST_CASE("polyhedra: where faces of one overlap, each pixel is the nearest one's, on a tie the first one's") {
  Random random(test_seed(4));
  CAPTURE(test_seed(4));
  std::size_t overlaps = 0;
  std::size_t not_first = 0;  // pixels that show another face than the first one there
  std::size_t not_last = 0;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(round);
    Config c;
    if (round % 2 != 0) {
      c.classic = 1;
      c.z_bits = 15;
      c.z_frac = 0;
    }
    Hits hits(kWidth, kHeight);
    FrameBuilder b = random_faces(random, hits);
    make_polyhedron(b.frame());
    const FrameGeometry& g = b.frame();
    const auto spans = picture(g, c).pixels;
    c.units = 1;
    const Picture tree = picture(g, c);
    CHECK(tree.pixels == spans);
    CHECK(tree.by_spans() == 0);
    count_segments(tree, g, c);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (hits.at(x, y) < 2) continue;
        ++overlaps;
        std::vector<std::uint32_t> there;
        for (std::uint32_t i = 0; i < g.drawn; ++i) {
          const auto outline = g.outline(g.polygons[i]);
          Hits one(kWidth, kHeight);
          one.add({outline.begin(), outline.end()});
          if (one.at(x, y) != 0) there.push_back(g.polygons[i].color[0]);
        }
        const auto at = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
        const std::uint32_t seen = spans[at] & 0xFFU;
        not_first += seen != there.front() ? 1 : 0;
        not_last += seen != there.back() ? 1 : 0;
      }
  }
  CAPTURE(overlaps, not_first, not_last);
  CHECK(overlaps > 10'000);
  CHECK(not_first > 1'000);
  CHECK(not_last > 1'000);
}

TEST_CASE(
    "polyhedra: a face whose depth leaves the accumulator makes spans, in the middle of a line or at its last pixel") {
  // A frame's line takes the face from depth 0 to `last` at its last pixel; 2^(Z_BITS + 1) is the first that is past
  // the range.
  const Config none;
  const double range = std::ldexp(1, none.z_bits + 1);
  for (const double last : {range / 2, range - 1, range + 1, 3 * range, 1 - range, -range - 1, -3 * range}) {
    CAPTURE(last);
    FrameBuilder b(kWidth, kHeight);
    b.add(rectangle(0, 1, kWidth, kHeight - 1), plane(0, last / (kWidth - 1)), {200, 0, 0});
    b.add(rectangle(5, 0, 9, kHeight), plane(1000), {100, 0, 0});
    make_polyhedron(b.frame());
    const auto spans = picture(b.frame(), none).pixels;
    Config c;
    c.units = 1;
    const Picture tree = picture(b.frame(), c);
    CHECK(tree.pixels == spans);
    CHECK(tree.by_segments() == (std::abs(last) < range ? 1 : 0));
    CHECK((tree.report.stop == PolyhedraReport::Stop::depth) == (tree.by_segments() == 0));
  }
}

TEST_CASE("polyhedra: a face whose rounded step alone would leave the accumulator makes spans") {
  const Config none;
  const double unit = std::ldexp(1, -none.z_frac);
  // Half an LSB is added to the start: the last pixel's sum may be one unit less than the range.
  const double most = std::ldexp(1, none.z_bits + 1) - 0.5;
  std::array<int, 2> ways{};  // by spans, by segments
  for (int below = 1; below <= 2 * kWidth; ++below) {
    CAPTURE(below);
    FrameBuilder b(kWidth, kHeight);
    b.add(rectangle(0, 0, kWidth, kHeight), plane(0, (most - below * unit) / (kWidth - 1)), {200, 0, 0});
    make_polyhedron(b.frame());
    Config c;
    c.units = 1;
    const Picture tree = picture(b.frame(), c);
    CHECK(tree.pixels == picture(b.frame(), none).pixels);
    ++ways.at(static_cast<std::size_t>(tree.by_segments()));
  }
  CHECK(ways[0] > 0);
  CHECK(ways[1] > 0);
}

}  // namespace kage::verif
