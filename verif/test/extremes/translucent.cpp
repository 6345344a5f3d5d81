// SPDX-License-Identifier: Apache-2.0
// Translucent faces on the screen: fragments part their faces exactly, and every pixel's layers come back to front.
#include <algorithm>

#include "kernels/span_kernels.hpp"
#include "oracle/face_pixels.hpp"
#include "oracle/layer_truth.hpp"
#include "oracle/simple_core.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 120;
constexpr int kHeight = 90;

Config glass() {
  Config c;
  c.translucency = 1;
  return c;
}

/// Panes and bodies through each other about the origin, among opaque ones.
SceneFrame random_glass(Random& random, int panes, int bodies, int opaque) {
  SceneFrame f = random_scene(random, opaque);
  const auto place = [&] { return glm::dvec3(random.real(-2, 2), random.real(-1.5, 1.5), random.real(-2, 2)); };
  const auto tint = [&] { return glm::dvec3(random.real(0, 1), random.real(0, 1), random.real(0, 1)); };
  const auto alpha = [&] { return static_cast<std::uint8_t>(random.in(60, 200)); };
  for (int i = 0; i < panes; ++i)
    add_glass(f, pane_solid(), place(), glm::dvec3(random.real(0.3, 1.5)), random_turn(random), tint(), alpha());
  for (int i = 0; i < bodies; ++i)
    add_glass(f, random.chance(0.5) ? box_solid() : octahedron_solid(), place(), glm::dvec3(random.real(0.2, 0.9)),
              random_turn(random), tint(), alpha());
  return f;
}

/// Spheres of glass about the origin, and a box through them. The eye is in the innermost, or outside.
SceneFrame nested_spheres(Random& random, bool perspective, bool inside) {
  SceneFrame f;
  const auto tint = [&] { return glm::dvec3(random.real(0, 1), random.real(0, 1), random.real(0, 1)); };
  for (int i = 0; i < 6; ++i)
    add_glass(f, raw_sphere_solid(static_cast<unsigned>(8 + i)), {0, 0, 0}, glm::dvec3(0.3 + 0.2 * i), Turn{}, tint(),
              90);
  add_glass(f, box_solid(), {0.9, 0, 0.2}, glm::dvec3(random.real(0.3, 0.8)), Turn{}, tint(), 90);
  const double far = inside ? 0.15 : 2.5;
  const glm::dvec3 eye = far * glm::dvec3(random.real(0.5, 1), random.real(-1, 1), random.real(0.5, 1));
  look_at(f.camera, eye, glm::dvec3(random.real(0.5, 1), random.real(-0.8, 0.3), 0) * (inside ? 1.0 : 0.2));
  f.camera.near = 0.01;
  f.camera.perspective = perspective;
  f.camera.half_height = perspective ? 0.76 : 1.2;
  return f;
}

}  // namespace

TEST_CASE("family 14: the fragments of a face part its pixels exactly, with its depths") {
  Random random(test_seed(14));
  CAPTURE(test_seed(14));
  std::uint64_t fragments = 0;
  std::uint64_t faces = 0;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_glass(random, random.in(2, 12), random.in(0, 3), 0);
    Look whole;
    whole.translucent = TranslucentWay::submission;
    const FrameGeometry cut = make_geometry(f, glass(), kWidth, kHeight);
    const FrameGeometry uncut = make_geometry(f, glass(), kWidth, kHeight, {.look = whole});
    fragments += cut.fragments.size();
    faces += uncut.fragments.size();
    const auto pixels = pixels_of_faces(cut, glass());
    CHECK(pixels == pixels_of_faces(uncut, glass()));
    CHECK(std::all_of(pixels.begin(), pixels.end(), [](const auto& p) { return std::get<0>(p.second) == 1; }));
  }
  CHECK(2 * fragments > 3 * faces);  // they were cut
}

TEST_CASE("family 38: every pixel's layers come back to front, as rays through the unsnapped scene say") {
  Random random(test_seed(38));
  CAPTURE(test_seed(38));
  LayerCount sum;
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const SceneFrame f = random_glass(random, random.in(2, 9), random.in(0, 3), random.in(0, 4));
    const LayerCount count = compare_layers(f, make_geometry(f, glass(), kWidth, kHeight), glass());
    INFO(count.text());
    CHECK(count.wrong == 0);
    sum += count;
  }
  INFO(sum.text());
  CHECK(sum.layered > 20'000);
  CHECK(sum.near * 100 < sum.pixels);
}

TEST_CASE("the judge of layers tells a wrong order: by centroid, by submission, and two exchanged fragments") {
  Random random(test_seed(39));
  CAPTURE(test_seed(39));
  std::uint64_t by_centroid = 0;
  std::uint64_t by_submission = 0;
  int exchanged = 0;
  int told = 0;
  for (int i = 0; i < 10; ++i) {
    const SceneFrame f = random_glass(random, 8, 1, 1);
    Look look;
    look.translucent = TranslucentWay::centroid;
    by_centroid += compare_layers(f, make_geometry(f, glass(), kWidth, kHeight, {.look = look}), glass()).wrong;
    look.translucent = TranslucentWay::submission;
    by_submission += compare_layers(f, make_geometry(f, glass(), kWidth, kHeight, {.look = look}), glass()).wrong;
    FrameGeometry g = make_geometry(f, glass(), kWidth, kHeight);
    if (g.fragments.size() < 2) continue;
    const auto before = draw_numbers(g, glass());
    std::swap(g.fragments.front(), g.fragments.back());
    if (draw_numbers(g, glass()) == before) continue;  // they nowhere overlap
    ++exchanged;
    told += compare_layers(f, g, glass()).wrong > 0 ? 1 : 0;
  }
  CHECK(by_centroid > 100);
  CHECK(by_submission > by_centroid);
  CHECK(exchanged > 0);
  CHECK(told == exchanged);
}

TEST_CASE("family 36: the eye on the planes of faces: seen edge-on they are culled, and the rest is in order") {
  // Panes through a point that the eye is on the planes of: one, then several at once.
  for (const bool perspective : {true, false})
    for (int panes = 1; panes <= 4; ++panes) {
      CAPTURE(perspective, panes);
      SceneFrame f;
      const glm::dvec3 eye{3, 0, 5};
      for (int i = 0; i < panes; ++i) {
        // The plane holds the eye (perspective) or the view's direction (parallel): x is along it, exactly.
        const glm::dvec3 up = i == 0 ? glm::dvec3(0, 1, 0) : glm::dvec3(0.5 * i, 1, 0);
        const glm::dvec3 at{0.25 * i, 0, 0};
        Solid s = pane_solid();
        for (glm::dvec3& v : s.vertices)
          v = at + (perspective ? (eye - at) : glm::dvec3(0, 0, 5)) * (v.x * 0.25) + up * v.y;
        add_glass(f, s, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0, 0}, 128);
      }
      const std::size_t edge_on = f.polygons.size();
      add_glass(f, pane_solid(), {0, 0, 0.5}, {2, 2, 1}, Turn{}, {0, 1, 0}, 100);
      add_glass(f, box_solid(), {0, 0, -1}, {1, 1, 1}, Turn{}, {0, 0, 1}, 150);
      f.camera.eye = eye;
      f.camera.near = 0.1;
      if (!perspective) {
        f.camera.perspective = false;
        f.camera.half_height = 2;
      }
      for (const ScreenFragment& s : make_geometry(f, glass(), kWidth, kHeight).fragments)
        CHECK(make_geometry(f, glass(), kWidth, kHeight).polygons[s.first_polygon].source >= edge_on);
      const LayerCount count = compare_layers(f, make_geometry(f, glass(), kWidth, kHeight), glass());
      INFO(count.text());
      CHECK(count.wrong == 0);
      CHECK(count.layered > 300);
    }
}

TEST_CASE("family 37: coplanar, nearly coplanar and duplicate panes, and panes that overlap each other in a ring") {
  Random random(test_seed(37));
  CAPTURE(test_seed(37));
  for (int i = 0; i < 20; ++i) {
    CAPTURE(i);
    // A ring: each pane is before the next and the last before the first.
    SceneFrame ring;
    for (int k = 0; k < 3; ++k) {
      const double a = 2.0943951 * k;
      Solid s = pane_solid();
      for (glm::dvec3& v : s.vertices) {
        const double r = 0.55 + 0.2 * v.x;
        v = {r * std::cos(a) - 1.3 * v.y * std::sin(a), r * std::sin(a) + 1.3 * v.y * std::cos(a), 0.2 * v.y};
      }
      add_glass(ring, s, {0, 0, 0}, {1, 1, 1}, Turn{}, {1, 0.5, 0.1 * k}, 120);
    }
    look_at(ring.camera, {random.real(-1, 1), random.real(-1, 1), random.real(3, 5)}, {0, 0, 0});
    const FrameGeometry g = make_geometry(ring, glass(), kWidth, kHeight);
    CHECK(g.fragments.size() > 6);  // six triangles, of which one at least is cut
    const LayerCount count = compare_layers(ring, g, glass());
    INFO(count.text());
    CHECK(count.wrong == 0);
    CHECK(count.layered > 50);
    // The same pane several times, some turned by next to nothing: all are drawn, each pixel once.
    SceneFrame same;
    const Turn turn = random_turn(random);
    for (int k = 0; k < 6; ++k) {
      Turn t = turn;
      if (k >= 3) t.x += glm::dvec3(1e-12, 3e-13, -1e-12) * static_cast<double>(k);
      add_glass(same, pane_solid(), {0, 0, 0}, {1, 1, 1}, t, {0.1 * k, 0.5, 0.3}, 120);
    }
    look_at(same.camera, {0.3, 0.2, 4}, {0, 0, 0});
    Look whole;
    whole.translucent = TranslucentWay::submission;
    const auto pixels = pixels_of_faces(make_geometry(same, glass(), kWidth, kHeight), glass());
    CHECK(pixels == pixels_of_faces(make_geometry(same, glass(), kWidth, kHeight, {.look = whole}), glass()));
    CHECK(std::all_of(pixels.begin(), pixels.end(), [](const auto& p) { return std::get<0>(p.second) == 1; }));
  }
}

TEST_CASE(
    "family 37: faces next to nothing wide: nested spheres with raw poles, through each other's and a box's faces") {
  Random random(test_seed(371));
  CAPTURE(test_seed(371));
  LayerCount sum;
  for (int i = 0; i < 8; ++i) {
    const bool perspective = i % 4 != 3;
    CAPTURE(i, perspective);
    const SceneFrame f = nested_spheres(random, perspective, i % 2 == 0);
    const LayerCount count = compare_layers(f, make_geometry(f, glass(), kWidth, kHeight), glass(), 3);
    INFO(count.text());
    CHECK(count.wrong == 0);
    sum += count;
  }
  INFO(sum.text());
  CHECK(sum.layered * 2 > sum.pixels);
  CHECK(sum.near * 50 < sum.pixels);
}

TEST_CASE("family 20: alpha 0 and 255 are identities, and 1000 layers are off by half an LSB each at most") {
  Random random(test_seed(20));
  CAPTURE(test_seed(20));
  const Config c = glass();
  for (const int alpha : {0, 1, 2, 127, 128, 254, 255}) {
    CAPTURE(alpha);
    std::vector<std::uint32_t> words;
    TokenWriter w(c, words);
    w.header({64, 1, 0x204060, 0});
    SpanToken s;
    s.xr = 40;  // the rest is background
    s.z = std::int64_t{1000} << c.z_frac;
    s.color = {200, 3, 77};
    w.op(s);
    s.xr = 64;
    s.z = std::int64_t{10} << c.z_frac;
    s.alpha = alpha;
    std::array<std::array<double, 3>, 2> exact{{{200, 3, 77}, {0x60, 0x40, 0x20}}};
    for (int layer = 0; layer < 1000; ++layer) {
      for (std::size_t i = 0; i < 3; ++i) s.color[i] = random.in(0, 255);
      w.tp(s);
      for (auto& e : exact)
        for (std::size_t i = 0; i < 3; ++i) e[i] += (s.color[i] - e[i]) * alpha / 255.0;
    }
    w.eol(0);
    w.end();
    check_frame(c, words, "test", 0);
    GoldenCore core(c);
    std::vector<std::uint8_t> line;
    (void)core.frame(words, [&](int, std::span<const std::uint8_t> p) { line.assign(p.begin(), p.end()); });
    REQUIRE(line.size() == std::size_t{64} * 3);
    double most = 0;
    for (std::size_t x = 0; x < 64; ++x)
      for (std::size_t i = 0; i < 3; ++i) {
        const double off = std::abs(line[3 * x + i] - exact[x < 40 ? 0 : 1][i]);
        most = std::max(most, off);
        if (alpha == 0 || alpha == 255) CHECK(off == 0);
      }
    // An error shrinks by 1 - alpha with every layer above it, so half an LSB each adds up to no more than this.
    const double share = alpha / 255.0;
    CHECK(most <= (alpha == 0 ? 0 : std::min(500.0, 0.5 / share)) + 1e-9);
    std::vector<std::uint8_t> plain;
    (void)simple_core(c, words, plain);
    CHECK(plain == line);
  }
}

TEST_CASE("family 20: every colour over every colour at every alpha is rounded to the nearest") {
  std::vector<std::int32_t> zb(256 + kKernelSlack, 100);
  std::vector<std::uint32_t> attr(zb.size());
  const DepthRamp before{std::int64_t{10} << 32, 0, 0, 1 << 20};
  int wrong = 0;
  for (std::int32_t alpha = 0; alpha < 256; ++alpha)
    for (std::int32_t over = 0; over < 256; ++over) {
      for (std::uint32_t x = 0; x < 256; ++x) attr[x] = x | (255 - x) << 8 | x << 16;
      const ColorRamp ramp{over << 22, 0};
      const std::array<ColorRamp, 3> ramps{ramp, ramp, ramp};
      span_tp(before, 256, zb.data(), attr.data(), ramps.data(), 3, alpha);
      const auto blended = [&](std::uint32_t under) {
        const auto sum = under * static_cast<std::uint32_t>(255 - alpha) + static_cast<std::uint32_t>(over * alpha);
        return (2 * sum + 255) / 510;
      };
      for (std::uint32_t x = 0; x < 256; ++x)
        wrong += attr[x] == (blended(x) | blended(255 - x) << 8 | blended(x) << 16) ? 0 : 1;
    }
  CHECK(wrong == 0);
}

TEST_CASE("translucent faces cast no shadow and take none; what is opaque beneath them keeps its own") {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -1.2, 0}, {4, 0.2, 4}, Turn{}, {0.8, 0.8, 0.8});
  add_solid(f, box_solid(), {0.8, 0, 0}, {0.4, 0.6, 0.4}, Turn{}, {0.9, 0.4, 0.2});
  SceneFrame with = f;
  add_glass(with, pane_solid(), {0, 0.2, 1.2}, {1.5, 1, 1}, Turn{}, {0.2, 0.4, 0.9}, 100);
  for (SceneFrame* s : {&f, &with}) {
    look_at(s->camera, {0, 1.5, 5}, {0, -0.3, 0});
    s->lights[0].directional = true;
    s->lights[0].direction = glm::normalize(glm::dvec3{-0.6, -0.7, 0.1});
  }
  const FrameGeometry bare = make_geometry(f, glass(), kWidth, kHeight);
  const FrameGeometry g = make_geometry(with, glass(), kWidth, kHeight);
  CHECK(g.volumes.size() == bare.volumes.size());
  const auto a = draw(bare, glass());
  const auto b = draw(g, glass());
  std::size_t under = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    ++under;
    // One layer over what was there, shadow and all.
    const auto& pane = g.polygons[g.fragments[0].first_polygon];
    for (unsigned ch = 0; ch < 3; ++ch) {
      const auto below = static_cast<double>(a[i] >> (8 * ch) & 255U);
      const auto shown = static_cast<double>(b[i] >> (8 * ch) & 255U);
      CHECK(std::abs(shown - (below * 155 + pane.color[ch] * 100.0) / 255) <= 0.5);
    }
  }
  CHECK(under > 500);
}

}  // namespace kage::verif
