// SPDX-License-Identifier: Apache-2.0
// Families 1 - 9, 11 and 13: which pixels a polygon covers.
#include "extremes/fill_rule.hpp"

#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"
#include "test/extremes/hold.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;

}  // namespace

TEST_CASE("family 1: a random triangulation of the screen hits every pixel once and none outside") {
  cases_hold<TriangulationCase>(100);
  // The whole screen, and more.
  Random random(test_seed());
  for (int round = 0; round < 50; ++round) {
    auto c = draw_case<TriangulationCase>(random);
    c.x0 = -700;
    c.y0 = -900;
    c.width = kWidth * 256 + 5700;
    c.height = kHeight * 256 + 1200;
    while (c.points.size() < 400) c.points.push_back(draw_case<NearPoint>(random));
    holds(c);
  }
}

TEST_CASE("family 2: every vertex order and winding gives the same hits") { cases_hold<VertexOrderCase>(300); }

TEST_CASE("family 3: a quad split along either diagonal has no hole and no double hit, at odd subpixels") {
  cases_hold<QuadCase>(500);
}

TEST_CASE("family 4: vertices on pixel centres and edges through them at all slopes: one owner") {
  for (int p = -20; p <= 20; ++p)
    for (const bool down : {false, true}) holds(CentresCase{40, 30, 20, p, down});
  cases_hold<CentresCase>(100);
  // Top-left rule: a rectangle from centre to centre owns its upper and left border, not the lower and right one.
  Hits own(kWidth, kHeight);
  own.add({{128, 128}, {128, 5 * 256 + 128}, {7 * 256 + 128, 5 * 256 + 128}, {7 * 256 + 128, 128}});
  CHECK(own.at(0, 0) == 1);
  CHECK(own.at(6, 4) == 1);
  CHECK(own.at(7, 4) == 0);
  CHECK(own.at(6, 5) == 0);
}

TEST_CASE("family 5: a fan of 1000 triangles round a pixel centre has one owner for it, and for every other pixel") {
  FanCase fan;
  for (int i = 0; i < 1000; ++i) fan.rim.push_back({48 * i});
  holds(fan);
  cases_hold<FanCase>(20);
}

TEST_CASE("family 6: slivers one subpixel wide and 32k long are the oracle's") { cases_hold<SliverCase>(240); }

TEST_CASE("family 7: zero area, collinear and repeated vertices make no span and change no state") {
  for (const Outline& o :
       {Outline{{100, 100}, {9000, 4000}, {100, 100}}, Outline{{128, 128}, {128, 128}, {128, 128}},
        Outline{{0, 0}, {2560, 2560}, {5120, 5120}}, Outline{{128, 384}, {9000, 384}, {500, 384}},
        Outline{{384, 128}, {384, 9000}, {384, 500}}, Outline{{128, 128}, {1280, 1280}, {1280, 1280}, {128, 128}}})
    holds(draws_nothing(o, kWidth, kHeight));
  cases_hold<FlatCase>(200);
}

TEST_CASE("family 8: near-horizontal edges, one subpixel high and as long as can be, cross where the oracle says") {
  cases_hold<LevelCase>(800);
}

TEST_CASE("family 9: coordinates at the guard band are exact, one past is refused") {
  constexpr int kLimit = kGuard * 256;
  holds(covers_what_the_oracle_says({{-kLimit, -kLimit}, {-kLimit, kLimit}, {kLimit, kLimit}}, 40, 30));
  holds(covers_what_the_oracle_says({{-kLimit, -kLimit}, {kLimit, kLimit}, {kLimit, -kLimit}}, 40, 30));
  // One corner at each limit in turn, and past it in each way.
  for (int past = 0; past < 8; ++past)
    for (int which = 0; which < 6; ++which)
      for (int kind = 0; kind < 5; ++kind) {
        GuardCase c{{0, 0, 0, 0}, {kind, 0, 0, 0}, {0, kind, 2560, 100}, past, which};
        holds(c);
      }
  cases_hold<GuardCase>(200);
}

TEST_CASE("family 11: a frame moved by whole pixels within the screen gives the picture moved") {
  cases_hold<MovedCase>(40);
}

TEST_CASE("family 13: spans of no, one and all pixels write 0, 1, W; joints at random x add up") {
  for (int x = 0; x <= kWidth; ++x) {
    holds(JointsCase{{{x}, {kWidth - x}}});
    holds(JointsCase{{{x}, {0}}});
    holds(JointsCase{{{x}, {1}}});
  }
  cases_hold<JointsCase>(300);
}

}  // namespace kage::verif
