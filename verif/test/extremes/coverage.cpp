// SPDX-License-Identifier: Apache-2.0
// Families 1 - 9, 11 and 13: which pixels a polygon covers.
#include <algorithm>
#include <array>

#include "kage/core.hpp"
#include "kage/error.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"
#include "opinion/judge.hpp"
#include "opinion/oracle.hpp"
#include "stimulus/random.hpp"
#include "test/support/catch.hpp"
#include "extremes/screen.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;

/// Triangles that together are the rectangle from (x0, y0) to (x1, y1), in subpixels: points are strewn into triangles,
/// which fall in three.
std::vector<Outline> triangulate(Random& random, int x0, int y0, int x1, int y1, int points) {
  std::vector<Outline> t{{{x0, y0}, {x0, y1}, {x1, y1}}, {{x0, y0}, {x1, y1}, {x1, y0}}};
  for (int i = 0; i < points; ++i) {
    const auto at = static_cast<std::size_t>(random.in(0, static_cast<int>(t.size()) - 1));
    const Outline o = t[at];
    ScreenVertex p;
    if (random.chance(0.5)) {
      p = {random.in(x0, x1), random.in(y0, y1)};
    } else {  // a pixel centre within the triangle's box
      p = {random.in(x0 >> 8, x1 >> 8) * 256 + 128, random.in(y0 >> 8, y1 >> 8) * 256 + 128};
    }
    const auto s0 = area2(o[0], o[1], p);
    const auto s1 = area2(o[1], o[2], p);
    const auto s2 = area2(o[2], o[0], p);
    if (!((s0 > 0 && s1 > 0 && s2 > 0) || (s0 < 0 && s1 < 0 && s2 < 0))) continue;  // outside or on an edge
    t[at] = {o[0], o[1], p};
    t.push_back({o[1], o[2], p});
    t.push_back({o[2], o[0], p});
  }
  return t;
}

void equals_oracle(const Outline& o, int width, int height) {
  Hits hits(width, height);
  hits.add(o);
  std::size_t wrong = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) wrong += hits.at(x, y) != (Oracle::winding(o, x, y) != 0 ? 1 : 0) ? 1U : 0U;
  CHECK(wrong == 0);
}

}  // namespace

TEST_CASE("family 1: a random triangulation of the screen hits every pixel once and none outside") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 50; ++round) {
    CAPTURE(round);
    Hits whole(kWidth, kHeight);
    for (const Outline& o : triangulate(random, -700, -900, kWidth * 256 + 5000, kHeight * 256 + 300, 400))
      whole.add(o);
    CHECK(whole.unlike(1) == 0);

    const int x0 = random.in(0, 20 * 256);
    const int y0 = random.in(0, 20 * 256);
    const int x1 = random.in(30 * 256, 70 * 256);
    const int y1 = random.in(30 * 256, 50 * 256);
    Hits part(kWidth, kHeight);
    for (const Outline& o : triangulate(random, x0, y0, x1, y1, 200)) part.add(o);
    Hits rect(kWidth, kHeight);
    rect.add({{x0, y0}, {x0, y1}, {x1, y1}, {x1, y0}});
    CHECK(part.all() == rect.all());
  }
}

TEST_CASE("family 2: every vertex order and winding gives the same hits") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 300; ++round) {
    Outline o;
    for (int i = 0; i < 3; ++i) o.push_back({random.in(-3000, 24000), random.in(-3000, 18000)});
    Hits first(kWidth, kHeight);
    first.add(o);
    for (int turn = 0; turn < 6; ++turn) {
      std::rotate(o.begin(), o.begin() + 1, o.end());
      if (turn == 2) std::reverse(o.begin(), o.end());
      Hits again(kWidth, kHeight);
      again.add(o);
      REQUIRE(again.all() == first.all());
    }
  }
}

TEST_CASE("family 3: a quad split along either diagonal has no hole and no double hit, at odd subpixels") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 500; ++round) {
    const auto odd = [&random](int low, int high) { return random.in(low, high) | 1; };
    // Corners in four quadrants about (40, 30), so that the quad is convex or at least simple.
    const ScreenVertex a{odd(0, 9000), odd(0, 7000)};
    const ScreenVertex b{odd(0, 9000), odd(8500, 15000)};
    const ScreenVertex c{odd(11500, 20000), odd(8500, 15000)};
    const ScreenVertex d{odd(11500, 20000), odd(0, 7000)};
    Hits quad(kWidth, kHeight);
    quad.add({a, b, c, d});
    for (const auto& [first, second] : {std::pair<Outline, Outline>{{a, b, c}, {a, c, d}}, {{a, b, d}, {b, c, d}}}) {
      // A diagonal outside a quad that is not convex turns one half over.
      if ((area2(first[0], first[1], first[2]) > 0) != (area2(second[0], second[1], second[2]) > 0)) continue;
      Hits halves(kWidth, kHeight);
      halves.add(first);
      halves.add(second);
      REQUIRE(halves.all() == quad.all());
    }
  }
}

TEST_CASE("family 4: vertices on pixel centres and edges through them at all slopes: one owner") {
  const ScreenVertex centre{40 * 256 + 128, 30 * 256 + 128};
  const int r = 20;  // pixels
  const ScreenVertex nw{centre.x - r * 256, centre.y - r * 256};
  const ScreenVertex ne{centre.x + r * 256, centre.y - r * 256};
  const ScreenVertex se{centre.x + r * 256, centre.y + r * 256};
  const ScreenVertex sw{centre.x - r * 256, centre.y + r * 256};
  Hits square(kWidth, kHeight);
  square.add({nw, sw, se, ne});
  for (int p = -r; p <= r; ++p) {
    CAPTURE(p);
    // A line through the centre with slope p / r, from side to side and from top to bottom.
    const ScreenVertex left{centre.x - r * 256, centre.y - p * 256};
    const ScreenVertex right{centre.x + r * 256, centre.y + p * 256};
    Hits across(kWidth, kHeight);
    across.add({nw, left, right, ne});
    across.add({left, sw, se, right});
    CHECK(across.all() == square.all());
    const ScreenVertex top{centre.x - p * 256, centre.y - r * 256};
    const ScreenVertex bottom{centre.x + p * 256, centre.y + r * 256};
    Hits down(kWidth, kHeight);
    down.add({nw, sw, bottom, top});
    down.add({top, bottom, se, ne});
    CHECK(down.all() == square.all());
  }
  // Top-left rule: a rectangle from centre to centre owns its upper and left border, not the lower and right one.
  Hits own(kWidth, kHeight);
  own.add({{128, 128}, {128, 5 * 256 + 128}, {7 * 256 + 128, 5 * 256 + 128}, {7 * 256 + 128, 128}});
  CHECK(own.at(0, 0) == 1);
  CHECK(own.at(6, 4) == 1);
  CHECK(own.at(7, 4) == 0);
  CHECK(own.at(6, 5) == 0);
}

TEST_CASE("family 5: a fan of 1000 triangles round a pixel centre has one owner for it, and for every other pixel") {
  const ScreenVertex hub{40 * 256 + 128, 30 * 256 + 128};
  std::vector<ScreenVertex> rim;
  rim.reserve(1000);
  // 1000 points on a square, in order.
  for (int i = 0; i < 250; ++i) rim.push_back({hub.x - 6000 + i * 48, hub.y - 6000});
  for (int i = 0; i < 250; ++i) rim.push_back({hub.x + 6000, hub.y - 6000 + i * 48});
  for (int i = 0; i < 250; ++i) rim.push_back({hub.x + 6000 - i * 48, hub.y + 6000});
  for (int i = 0; i < 250; ++i) rim.push_back({hub.x - 6000, hub.y + 6000 - i * 48});
  Hits fan(kWidth, kHeight);
  for (std::size_t i = 0; i < rim.size(); ++i) fan.add({hub, rim[i], rim[(i + 1) % rim.size()]});
  Hits square(kWidth, kHeight);
  square.add({rim[0], rim[250], rim[500], rim[750]});
  CHECK(fan.at(40, 30) == 1);
  CHECK(fan.all() == square.all());
}

TEST_CASE("family 6: slivers one subpixel wide and 32k long are the oracle's") {
  Random random(test_seed());
  CAPTURE(test_seed());
  constexpr int kLimit = kGuard * 256;
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    const ScreenVertex a{random.in(-kLimit, -kLimit + 256 * 700), random.in(0, kHeight * 256)};
    const ScreenVertex b{random.in(kLimit - 256 * 700, kLimit), random.in(0, kHeight * 256)};
    equals_oracle({a, b, {b.x, b.y + 1}}, kWidth, kHeight);
    equals_oracle({a, {a.x, a.y + 1}, {b.x, b.y + 1}, b}, kWidth, kHeight);
    const ScreenVertex c{random.in(0, kWidth * 256), -kLimit};
    const ScreenVertex d{random.in(0, kWidth * 256), kLimit};
    equals_oracle({c, d, {d.x + 1, d.y}}, kWidth, kHeight);
    equals_oracle({c, {c.x + 1, c.y}, {d.x + 1, d.y}, d}, kWidth, kHeight);
  }
}

TEST_CASE("family 7: zero area, collinear and repeated vertices make no span and change no state") {
  for (const Outline& o :
       {Outline{{100, 100}, {9000, 4000}, {100, 100}}, Outline{{128, 128}, {128, 128}, {128, 128}},
        Outline{{0, 0}, {2560, 2560}, {5120, 5120}}, Outline{{128, 384}, {9000, 384}, {500, 384}},
        Outline{{384, 128}, {384, 9000}, {384, 500}}, Outline{{128, 128}, {1280, 1280}, {1280, 1280}, {128, 128}}}) {
    Hits hits(kWidth, kHeight);
    hits.add(o);
    CHECK(hits.unlike(0) == 0);
    FrameBuilder with(kWidth, kHeight);
    with.add(rectangle(0, 0, 10, 10), plane(1000), {1, 2, 3});
    std::vector<std::uint32_t> plain;
    make_frame(with.frame(), Config{}, 0, plain, {.threads = 1});
    with.add(o, plane(10), {255, 255, 255});
    std::vector<std::uint32_t> more;
    make_frame(with.frame(), Config{}, 0, more, {.threads = 1});
    CHECK(more == plain);
  }
}

TEST_CASE("family 8: near-horizontal edges, one subpixel high and as long as can be, cross where the oracle says") {
  Random random(test_seed());
  CAPTURE(test_seed());
  constexpr int kLimit = kGuard * 256;
  for (int round = 0; round < 200; ++round) {
    const int line = random.in(0, kHeight - 1) * 256 + 128;
    for (const int y0 : {line - 1, line}) {  // the centre is on the lower or on the upper end
      equals_oracle({{-kLimit, y0}, {kLimit, y0 + 1}, {random.in(-kLimit, kLimit), 50 * 256}}, kWidth, kHeight);
      equals_oracle({{kLimit, y0}, {-kLimit, y0 + 1}, {random.in(-kLimit, kLimit), 0}}, kWidth, kHeight);
    }
  }
}

TEST_CASE("family 9: coordinates at the guard band are exact, one past is refused") {
  constexpr int kLimit = kGuard * 256;
  equals_oracle({{-kLimit, -kLimit}, {-kLimit, kLimit}, {kLimit, kLimit}}, 40, 30);
  equals_oracle({{-kLimit, -kLimit}, {kLimit, kLimit}, {kLimit, -kLimit}}, 40, 30);
  const auto frame_with = [](std::int32_t x, std::int32_t y) {
    FrameBuilder b(40, 30);
    b.add({{0, 0}, {x, y}, {2560, 100}}, plane(1000));
    std::vector<std::uint32_t> words;
    make_frame(b.frame(), Config{}, 0, words, {.threads = 1});
    check_frame(Config{}, words, "test", 0);
  };
  for (const std::int32_t at : {kLimit, -kLimit}) {
    CHECK_NOTHROW(frame_with(at, 0));
    CHECK_NOTHROW(frame_with(0, at));
  }
  for (const std::int32_t at :
       {kLimit + 1, -kLimit - 1, (1 << 15) * 256, -(1 << 15) * 256, (1 << 15) * 256 + 1, INT32_MAX, INT32_MIN}) {
    CHECK_THROWS_AS(frame_with(at, 0), Error);
    CHECK_THROWS_AS(frame_with(0, at), Error);
  }
}

TEST_CASE("family 11: a frame moved by whole pixels within the screen gives the picture moved") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int round = 0; round < 20; ++round) {
    const int dx = random.in(-15, 15);
    const int dy = random.in(-10, 10);
    FrameBuilder here(kWidth, kHeight);
    FrameBuilder there(kWidth, kHeight);
    for (int i = 0; i < 20; ++i) {
      Outline o;
      Outline moved;
      for (int v = 0; v < 3; ++v) {
        o.push_back({random.in(16 * 256, 64 * 256), random.in(11 * 256, 49 * 256)});
        moved.push_back({o.back().x + 256 * dx, o.back().y + 256 * dy});
      }
      ScreenPlane p = plane(random.real(1e5, 1.6e7), random.real(-1e4, 1e4), random.real(-1e4, 1e4), 40, 30);
      const std::array<std::uint8_t, 3> color{static_cast<std::uint8_t>(10 * i), 7, static_cast<std::uint8_t>(i)};
      here.add(o, p, color);
      p.x0 += dx;
      p.y0 += dy;
      there.add(moved, p, color);
    }
    const auto a = draw(here.frame(), Config{});
    const auto b = draw(there.frame(), Config{});
    std::size_t wrong = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const int fx = x - dx;
        const int fy = y - dy;
        const bool inside = fx >= 0 && fx < kWidth && fy >= 0 && fy < kHeight;
        const int from = fy * kWidth + fx;
        const int to = y * kWidth + x;
        wrong += b[static_cast<std::size_t>(to)] != (inside ? a[static_cast<std::size_t>(from)] : 0U) ? 1U : 0U;
      }
    CHECK(wrong == 0);
  }
}

TEST_CASE("family 13: spans of no, one and all pixels write 0, 1, W; joints at random x add up") {
  Random random(test_seed());
  CAPTURE(test_seed());
  const Config config;
  const auto pixels_of = [&](const std::vector<SpanToken>& spans) {
    std::vector<std::uint32_t> words;
    TokenWriter w(config, words);
    w.header({kWidth, 1, 0, 0});
    for (const SpanToken& s : spans) w.op(s);
    w.eol(0);
    w.end();
    GoldenCore core(config);
    std::vector<std::uint8_t> out;
    const FrameStatus status =
        core.frame(words, [&out](int, std::span<const std::uint8_t> p) { out.assign(p.begin(), p.end()); });
    REQUIRE(status.error == ErrorCode::NONE);
    return out;
  };
  const auto span_at = [](int xl, int xr, int z, int color) {
    SpanToken s;
    s.xl = xl;
    s.xr = xr;
    s.z = std::int64_t{z} << 11;
    s.color = {color, color, color};
    return s;
  };
  const auto written = [&](int xl, int xr) {
    const auto p = pixels_of({span_at(xl, xr, 100, 9)});
    return std::count(p.begin(), p.end(), 9) / 3;
  };
  for (int x = 0; x <= kWidth; ++x) {
    CHECK(written(x, x) == 0);
    if (x < kWidth) CHECK(written(x, x + 1) == 1);
    CHECK(written(0, x) == x);
    CHECK(written(x, kWidth) == kWidth - x);
  }
  for (int round = 0; round < 200; ++round) {
    // Later spans are nearer: a pixel hit twice would show the later one.
    std::vector<SpanToken> spans;
    std::vector<std::uint8_t> expected(static_cast<std::size_t>(kWidth) * 3);
    int color = 1;
    for (int x = 0; x < kWidth;) {
      const int to = std::min(kWidth, x + random.in(0, 9));
      spans.push_back(span_at(x, to, 1000 - color, color));
      std::fill(expected.begin() + std::ptrdiff_t{3} * x, expected.begin() + std::ptrdiff_t{3} * to,
                static_cast<std::uint8_t>(color));
      x = to;
      ++color;
    }
    REQUIRE(pixels_of(spans) == expected);
  }
}

}  // namespace kage::verif
