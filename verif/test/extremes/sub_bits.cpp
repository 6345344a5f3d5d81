// SPDX-License-Identifier: Apache-2.0
// Positions rounded to 1/16 .. 1/256 pixel (Look::sub_bits): families 1 - 5, 21 and 22 hold with each.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "extremes/screen.hpp"
#include "kage/error.hpp"
#include "oracle/layer_truth.hpp"
#include "oracle/ray_truth.hpp"
#include "stimulus/shapes.hpp"
#include "test/scene/shadow_checks.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;
constexpr std::array kSubBits{4, 5, 6, 7, 8};

Look look_of(int sub_bits) {
  Look look;
  look.sub_bits = sub_bits;
  return look;
}

/// A scene whose triangles the snap must bring to the given corners, seen in parallel, a unit a pixel. Each corner is
/// off by up to half a step; its offset counts in 64ths of a step, so that no double rounds. A corner half a step
/// before goes to it, one half a step past it to the next one. Depths are at random, so that no two triangles lie in a
/// plane.
class Unsnapped {
 public:
  Unsnapped(Random& random, int sub_bits) : random_(&random), step_(1 << (8 - sub_bits)), look_(look_of(sub_bits)) {
    look_at(frame_.camera, {0, 0, 10}, {0, 0, 0});
    frame_.camera.perspective = false;
    frame_.camera.half_height = kHeight / 2.0;
    frame_.camera.near = 1;
    look_.depth_from_near =
        true;  // corners beside the picture that lie near the eye stay: positions are what is tested
  }

  [[nodiscard]] int step() const { return step_; }

  void add(const Outline& triangle) {
    Solid solid;
    for (const ScreenVertex& v : triangle) {
      auto [at, is_new] = places_.try_emplace({v.x, v.y});
      if (is_new) at->second = {place(v.x) - kWidth / 2.0, kHeight / 2.0 - place(v.y), random_->in(-32, 32) / 8.0};
      solid.vertices.push_back(at->second);
    }
    solid.faces = {{0, 1, 2}};
    add_solid(frame_, solid, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 1, 1}, false, false);
    expected_.push_back(triangle);
  }

  /// The hits of what make_geometry() makes of it, which must be the triangles that were added.
  [[nodiscard]] Hits hits() const {
    const FrameGeometry g = make_geometry(frame_, {}, kWidth, kHeight, {.look = look_});
    Hits hits(kWidth, kHeight);
    REQUIRE(g.drawn == expected_.size());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < expected_.size(); ++i) {
      const auto outline = g.outline(g.polygons[i]);
      const Outline got(outline.begin(), outline.end());
      wrong += got == expected_[i] ? 0 : 1;
      hits.add(got);
    }
    CHECK(wrong == 0);
    return hits;
  }

 private:
  double place(int at) {
    const int off = random_->chance(0.2) ? -32 : random_->in(-32, 31);
    return (at + off * step_ / 64.0) / 256.0;
  }

  Random* random_;
  int step_;
  Look look_;
  SceneFrame frame_;
  std::map<std::pair<int, int>, glm::dvec3> places_;
  std::vector<Outline> expected_;
};

Hits hits_of(const std::vector<Outline>& triangles, Random& random, int sub_bits) {
  Unsnapped scene(random, sub_bits);
  for (const Outline& o : triangles) scene.add(o);
  return scene.hits();
}

}  // namespace

TEST_CASE("family 1, each SUB_BITS: a triangulation of the screen hits every pixel once") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (const int bits : kSubBits)
    for (int round = 0; round < 10; ++round) {
      CAPTURE(bits, round);
      const auto triangles =
          triangulate(random, -704, -896, kWidth * 256 + 4992, kHeight * 256 + 304, 300, 1 << (8 - bits));
      CHECK(hits_of(triangles, random, bits).unlike(1) == 0);
    }
}

TEST_CASE("family 2, each SUB_BITS: every vertex order and winding gives the same hits, the oracle's") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (const int bits : kSubBits)
    for (int round = 0; round < 40; ++round) {
      CAPTURE(bits, round);
      const int step = 1 << (8 - bits);
      Outline o;
      for (int i = 0; i < 3; ++i)
        o.push_back({random.in(-3000 / step, 24000 / step) * step, random.in(-3000 / step, 18000 / step) * step});
      if (area2(o[0], o[1], o[2]) == 0) continue;
      std::vector<int> first(static_cast<std::size_t>(kWidth) * kHeight);
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) first[pixel_index(x, y, kWidth)] = Oracle::winding(o, x, y) != 0 ? 1 : 0;
      for (int turn = 0; turn < 6; ++turn) {
        std::rotate(o.begin(), o.begin() + 1, o.end());
        if (turn == 2) std::reverse(o.begin(), o.end());
        REQUIRE(hits_of({o}, random, bits).all() == first);
      }
    }
}

TEST_CASE("family 3, each SUB_BITS: a quad split along either diagonal is the same pixels, at odd steps") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (const int bits : kSubBits)
    for (int round = 0; round < 60; ++round) {
      CAPTURE(bits, round);
      const int step = 1 << (8 - bits);
      const auto odd = [&](int low, int high) { return (random.in(low / step, high / step) | 1) * step; };
      const ScreenVertex a{odd(0, 9000), odd(0, 7000)};
      const ScreenVertex b{odd(0, 9000), odd(8500, 15000)};
      const ScreenVertex c{odd(11500, 20000), odd(8500, 15000)};
      const ScreenVertex d{odd(11500, 20000), odd(0, 7000)};
      Hits quad(kWidth, kHeight);
      quad.add({a, b, c, d});
      for (const auto& [first, second] : {std::pair<Outline, Outline>{{a, b, c}, {a, c, d}}, {{a, b, d}, {b, c, d}}}) {
        if ((area2(first[0], first[1], first[2]) > 0) != (area2(second[0], second[1], second[2]) > 0)) continue;
        REQUIRE(hits_of({first, second}, random, bits).all() == quad.all());
      }
    }
}

TEST_CASE("families 4 and 5, each SUB_BITS: edges through a pixel's centre and a fan round one have one owner") {
  Random random(test_seed());
  CAPTURE(test_seed());
  const ScreenVertex hub{40 * 256 + 128, 30 * 256 + 128};
  for (const int bits : kSubBits) {
    CAPTURE(bits);
    const int r = 20 * 256;
    const ScreenVertex nw{hub.x - r, hub.y - r};
    const ScreenVertex ne{hub.x + r, hub.y - r};
    const ScreenVertex se{hub.x + r, hub.y + r};
    const ScreenVertex sw{hub.x - r, hub.y + r};
    Hits square(kWidth, kHeight);
    square.add({nw, sw, se, ne});
    for (int p = -20; p <= 20; p += 4) {
      const ScreenVertex left{hub.x - r, hub.y - p * 256};
      const ScreenVertex right{hub.x + r, hub.y + p * 256};
      std::vector<Outline> parts{{nw, right, ne}, {left, se, right}};
      if (p != 20) parts.push_back({nw, left, right});
      if (p != -20) parts.push_back({left, sw, se});
      std::erase_if(parts, [](const Outline& o) { return area2(o[0], o[1], o[2]) == 0; });
      REQUIRE(hits_of(parts, random, bits).all() == square.all());
    }
    std::vector<ScreenVertex> rim;
    for (int i = 0; i < 250; ++i) rim.push_back({hub.x - 6000 + i * 48, hub.y - 6000});
    for (int i = 0; i < 250; ++i) rim.push_back({hub.x + 6000, hub.y - 6000 + i * 48});
    for (int i = 0; i < 250; ++i) rim.push_back({hub.x + 6000 - i * 48, hub.y + 6000});
    for (int i = 0; i < 250; ++i) rim.push_back({hub.x - 6000, hub.y + 6000 - i * 48});
    std::vector<Outline> fan;
    for (std::size_t i = 0; i < rim.size(); ++i) fan.push_back({hub, rim[i], rim[(i + 1) % rim.size()]});
    Hits whole(kWidth, kHeight);
    whole.add({rim[0], rim[250], rim[500], rim[750]});
    REQUIRE(hits_of(fan, random, bits).all() == whole.all());
  }
}

TEST_CASE(
    "each SUB_BITS: coordinates are its multiples, within the guard band, of faces cut there and at the near plane") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (const int bits : kSubBits) {
    CAPTURE(bits);
    std::size_t at_guard = 0;
    std::size_t cut = 0;
    for (int i = 0; i < 60; ++i) {
      SceneFrame f = random_scene(random, 3, i % 2 == 0);
      f.camera.near = 1e-4;  // what is close by reaches far past the guard band
      Look look = look_of(bits);
      look.depth_from_near = true;
      const FrameGeometry g = make_geometry(f, {}, kWidth, kHeight, {.look = look});
      const auto sound = [&](const ScreenVertex& v) {
        at_guard += std::abs(v.x) == kGuard * 256 || std::abs(v.y) == kGuard * 256 ? 1 : 0;
        return std::abs(v.x) <= kGuard * 256 && std::abs(v.y) <= kGuard * 256 && v.x % snap_step(g) == 0 &&
               v.y % snap_step(g) == 0;
      };
      REQUIRE(std::all_of(g.vertices.begin(), g.vertices.end(), sound));
      REQUIRE(std::all_of(g.near_edges.begin(), g.near_edges.end(),
                          [&](const NearEdge& e) { return sound(e.from) && sound(e.to); }));
      REQUIRE(std::all_of(g.polyhedron_edges.begin(), g.polyhedron_edges.end(),
                          [&](const PolyhedronEdge& e) { return sound(e.from) && sound(e.to); }));
      cut += g.near_edges.size();
    }
    CHECK(at_guard > 20);
    CHECK(cut > 20);
  }
}

TEST_CASE("family 21, each SUB_BITS: volumes are closed, and pictures are the oracle's and what rays say") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  for (const int bits : kSubBits) {
    const auto rays = [&](int i) {
      CAPTURE(bits);
      const SceneFrame f = random_scene(random, random.in(1, 6), i % 2 == 0);
      if (i < 10) sums_are_zero(f, {}, kWidth, kHeight, look_of(bits));
      judge_all(f, {}, kWidth, kHeight, look_of(bits));
      const Config c = counting(i % 4 == 3 ? 4 : 1);
      return compare_with_rays(f, make_geometry(f, c, kWidth, kHeight, {.look = look_of(bits)}), c);
    };
    std::printf("SUB_BITS %d: %s\n", bits, rays_agree(40, rays, 0.04).text().c_str());
  }
}

TEST_CASE("rays tell a frame of 4 SUB_BITS from one that says it has 8") {
  Random random(test_seed(4));
  CAPTURE(test_seed(4));
  std::uint64_t wrong = 0;
  for (int i = 0; i < 20; ++i) {
    const SceneFrame f = random_scene(random, 5);
    FrameGeometry g = make_geometry(f, {}, kWidth, kHeight, {.look = look_of(4)});
    g.sub_bits = 8;
    const RayCount count = compare_with_rays(f, g, {});
    wrong += count.wrong_surface + count.wrong_shadow;
  }
  CHECK(wrong > 20);
}

TEST_CASE("family 22, each SUB_BITS: nested, overlapping and touching casters in any order give one picture") {
  Random random(test_seed(5));
  CAPTURE(test_seed(5));
  for (const int bits : kSubBits)
    for (int k = 0; k <= 64; k += 8) {
      CAPTURE(bits, k);
      std::vector<int> order(static_cast<std::size_t>(k));
      for (int i = 0; i < k; ++i) order[static_cast<std::size_t>(i)] = i;
      std::vector<std::uint32_t> first;
      for (int round = 0; round < 2; ++round) {
        const SceneFrame f = box_threes(order, 0.4);
        judge_all(f, {}, kWidth, kHeight, look_of(bits));
        const auto pixels = draw(make_geometry(f, {}, kWidth, kHeight, {.look = look_of(bits)}), {});
        if (round == 0) first = pixels;
        CHECK(pixels == first);
        random.shuffle(order);
      }
    }
}

TEST_CASE("each SUB_BITS: translucent layers are what rays say") {
  Random random(test_seed(6));
  CAPTURE(test_seed(6));
  for (const int bits : kSubBits) {
    LayerCount count;
    for (int i = 0; i < 12; ++i) {
      CAPTURE(bits, i);
      SceneFrame f = random_scene(random, 3);
      for (int k = 0; k < 4; ++k)
        add_glass(f, pane_solid(), {random.real(-2, 2), random.real(-2, 2), random.real(-2, 2)}, {2, 1.5, 1},
                  random_turn(random), {1, 1, 1}, 100);
      Config c;
      c.translucency = 1;
      count += compare_layers(f, make_geometry(f, c, kWidth, kHeight, {.look = look_of(bits)}), c);
      INFO(count.text());
      REQUIRE(count.wrong == 0);
    }
    CHECK(count.layered > 500);
  }
}

TEST_CASE("SUB_BITS other than 4 to 8 are refused") {
  Random random(test_seed(7));
  const SceneFrame f = random_scene(random, 2);
  for (const int bits : {-1, 0, 3, 9, 31})
    CHECK_THROWS_WITH(make_geometry(f, {}, kWidth, kHeight, {.look = look_of(bits)}),
                      fmt::format("{} bits of a subpixel: there must be 4 .. 8", bits));
}

}  // namespace kage::verif
