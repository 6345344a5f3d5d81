// SPDX-License-Identifier: Apache-2.0
// The paper's segments, CLASSIC: two 16-bit words, depth of 15 bits without a fraction. [Ohno 1985]
#include "catch.hpp"
#include "support/shapes.hpp"
#include "support/tree_frames.hpp"

namespace kage::verif {
namespace {

using Counts = std::array<SegmentCount, kUnitCounts.size()>;

Config classic_format() {
  Config c;
  c.classic = 1;
  c.z_bits = 15;
  c.z_frac = 0;
  return c;
}

}  // namespace

TEST_CASE("the paper's format gives the same bits by segments and by spans") {
  Random random(test_seed(34));
  CAPTURE(test_seed(34));
  std::uint64_t segments = 0;
  int by_segments = 0;
  int by_spans = 0;
  for (int i = 0; i < 30; ++i) {
    CAPTURE(i);
    const Counts counts = same_either_way(random_scene(random, random.in(1, 8), true), classic_format(), 96, 72);
    segments += counts.back().of_faces;
    by_segments += counts.back().by_segments;
    by_spans += counts.back().by_spans;
  }
  CAPTURE(segments, by_segments, by_spans);
  CHECK(segments > 1000);
  CHECK(by_segments > 60);
  CHECK(by_spans < by_segments / 10);
}

TEST_CASE("the paper's format: a split run whose sum leaves 15 bits makes spans, not an error") {
  // Long thin walls, nearly facing the eye, as deep as the scene: the step is a small fraction that rounds badly.
  bool by_segments = false;
  bool by_spans = false;
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const double a = (i % 2 == 0 ? -1 : 1) * (0.012 + 0.0001 * i);
    SceneFrame f;
    add_solid(f, box_solid(), {0, 0, 0}, {7.5, 0.3, 0.0001},
              Turn{{std::cos(a), 0, -std::sin(a)}, {0, 1, 0}, {std::sin(a), 0, std::cos(a)}}, {1, 0.6, 0.2});
    look_at(f.camera, {0, 0, 20}, {0, 0, 0});
    f.camera.perspective = false;
    f.camera.half_height = 0.6;
    const Counts counts = same_either_way(f, classic_format(), 640, 48);
    // Units are of no help where the format is the cause.
    for (const SegmentCount& n : counts) CHECK(n.by_segments == counts.front().by_segments);
    (counts.front().by_segments == 1 ? by_segments : by_spans) = true;
  }
  CHECK(by_segments);
  CHECK(by_spans);
}

}  // namespace kage::verif
