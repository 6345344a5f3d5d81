// SPDX-License-Identifier: Apache-2.0
// Diced faces. Their parts tile their spans with the very depths, so that nothing but colours and classes moves. Where
// no shadow lies, colours are near the reference of light. And there are no more parts than pixels.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "explore/accuracy.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"
#include "oracle/judge.hpp"
#include "oracle/light_reference.hpp"
#include "stimulus/random.hpp"
#include "stimulus/scenes/lit_scenes.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::verif;

namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

Config smooth(const SceneFrame& f, int class_bits) {
  Config c;
  c.smooth = 1;
  c.color_frac = 12;
  c.shade_frac = 16;
  c.translucency = 1;
  c.lights = static_cast<int>(f.lights.size());
  c.class_bits = class_bits;
  c.count_bits = 4;
  return c;
}

/// A scene's frames: the built-in ones whose colours vary within faces, and those made for light.
std::vector<SceneFrame> frames() {
  std::vector<SceneFrame> list;
  for (const char* name : {"knot", "inside", "glass", "penumbra", "three-lights", "cutaway"})
    list.push_back(Scene::load(name).frame(0, 1));
  for (const LitScene& s : lit_scenes()) list.push_back(Scene::from(s.parts).frame(0, 1));
  // Panes that cross, near a lamp.
  SceneFrame panes = list[1];  // inside
  for (Triangle& t : panes.triangles) t.alpha = 100;
  for (Component& c : panes.components) c.translucent = true;
  list.push_back(panes);
  return list;
}

FrameGeometry geometry(const SceneFrame& f, const Config& c, int max_shading) {
  Look look;
  look.max_shading = max_shading;
  return make_geometry(f, c, kWidth, kHeight, {.look = look});
}

/// The spans of a frame's drawn polygons, opaque and translucent, with the polygon that each is of.
struct Owned {
  std::uint32_t polygon;
  int line;
  SpanToken span;
};
std::vector<Owned> spans_of(const FrameGeometry& g, const Config& c, Kind kind) {
  FrameOrigins origins;
  std::vector<std::uint32_t> words;
  make_frame(g, c, 0, words, {.threads = 1, .origins = &origins, .all_spans = true});
  const std::vector<TokenOrigin>& from = kind == Kind::OP ? origins.opaque : origins.translucent;
  std::vector<Owned> out;
  int line = 0;
  const Layout layout(c);
  TokenWalk walk(layout, words);
  for (auto at = walk.next(); !at.empty(); at = walk.next()) {
    const Token t = decode(c, layout, at);
    if (t.kind == kind) out.push_back({from.at(out.size()).polygon, line, t.span});
    if (t.kind == Kind::EOL) ++line;
  }
  CHECK(out.size() == from.size());
  return out;
}

}  // namespace

TEST_CASE("the parts of a diced polygon tile its spans, with the depths of the whole") {
  std::array<std::uint64_t, 2> parts{};  // beyond one of each span: of opaque and of translucent ones
  for (const SceneFrame& f : frames())
    for (const int class_bits : {4, 8}) {
      const Config c = smooth(f, class_bits);
      const FrameGeometry diced = geometry(f, c, 1);
      FrameGeometry whole = diced;
      for (ScreenPolygon& p : whole.polygons) p.shade_cut = -1;
      for (const Kind kind : {Kind::OP, Kind::TP}) {
        const auto of_parts = spans_of(diced, c, kind);
        const auto of_whole = spans_of(whole, c, kind);
        auto part = of_parts.begin();
        for (const Owned& w : of_whole) {
          for (int x = w.span.xl; x < w.span.xr; ++part) {
            REQUIRE(part != of_parts.end());
            REQUIRE(std::tie(part->polygon, part->line, part->span.xl) == std::tie(w.polygon, w.line, x));
            REQUIRE(part->span.xr > x);
            REQUIRE(part->span.z == w.span.z + (x - w.span.xl) * w.span.dz);
            REQUIRE(part->span.dz == w.span.dz);
            REQUIRE(part->span.alpha == w.span.alpha);
            x = part->span.xr;
            ++parts[kind == Kind::OP ? 0 : 1];
          }
          CHECK((part - 1)->span.xr == w.span.xr);
        }
        CHECK(part == of_parts.end());
        parts[kind == Kind::OP ? 0 : 1] -= of_whole.size();
      }
    }
  CHECK(parts[0] > 10000);
  CHECK(parts[1] > 1000);
}

TEST_CASE("faces, depths and shadows are the same however a frame is diced") {
  for (const SceneFrame& f : frames()) {
    const Config c = smooth(f, 8);
    DrawOptions options{.width = kWidth, .height = kHeight};
    options.look.max_shading = 0;
    const explore::DrawnFrame plain = explore::draw(f, c, options);
    for (const int max_shading : {1, 2, 9}) {
      options.look.max_shading = max_shading;
      const explore::DrawnFrame diced = explore::draw(f, c, options);
      CHECK(diced.face == plain.face);
      CHECK(diced.z == plain.z);
      CHECK(diced.counts == plain.counts);
    }
  }
}

// Light is looked at every 2 to 4 pixels, and a part is not cut below two. So within a part colours are off by no more
// than --max-shading and half of the light's change among neighbours. A step more is for the rounding of colours and
// for the transfer function.
TEST_CASE("where no shadow lies on the floor its colours are within --max-shading of the reference") {
  for (const LitScene& lit : lit_scenes()) {
    const SceneFrame f = Scene::from(lit.parts).frame(0, 1);
    const RayScene rays(f);
    const LightReference reference(f, rays, sampled_points(f, {}), kWidth, kHeight);
    std::vector<std::optional<glm::dvec3>> lit_floor;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const ReferencePixel p = reference.pixel_with_ties(x, y, 1.0 / 128);
        const auto on_floor = [&](std::uint32_t corner) { return f.vertices[corner].y == 0; };
        const auto corners = p.face == kNothing ? std::span<const std::uint32_t>() : f.outline(f.polygons[p.face]);
        const bool counts =
            p.face != kNothing && !p.tie && !p.shadowed && std::all_of(corners.begin(), corners.end(), on_floor);
        lit_floor.push_back(counts ? std::optional(p.color) : std::nullopt);
      }
    const auto at = [&](int x, int y) -> const std::optional<glm::dvec3>& {
      return lit_floor[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
    };
    const Config c = smooth(f, 8);
    for (const int max_shading : {0, 1, 2, 4, 8}) {
      CAPTURE(lit.name, max_shading);
      const std::vector<std::uint32_t> picture = draw(geometry(f, c, max_shading), c);
      int compared = 0;
      int far = 0;
      for (int y = 1; y + 1 < kHeight; ++y)
        for (int x = 1; x + 1 < kWidth; ++x) {
          if (!at(x, y)) continue;
          ++compared;
          const std::uint32_t shown = picture[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
          for (int k = 0; k < 3; ++k) {
            double least = 255;
            double most = 0;
            for (int v = y - 1; v <= y + 1; ++v)
              for (int u = x - 1; u <= x + 1; ++u) {
                least = at(u, v) ? std::min(least, (*at(u, v))[k]) : least;
                most = at(u, v) ? std::max(most, (*at(u, v))[k]) : most;
              }
            const double off = std::abs((shown >> (8 * k) & 255U) - (*at(x, y))[k]);
            far += off > max_shading + 1 + 0.5 * (most - least) ? 1 : 0;
          }
        }
      CHECK(compared > 500);
      if (max_shading > 0) CHECK(far == 0);
      if (max_shading == 0 && (lit.name == "two-triangles" || lit.name == "spot-inside")) CHECK(far > 1000);
    }
  }
}

TEST_CASE("lamps on, near and far from a face are diced within the picture's pixels, the same each time") {
  Random random(test_seed(49));
  for (int round = 0; round < 60; ++round) {
    const auto all = lit_scenes();
    LitScene lit = *std::find_if(all.begin(), all.end(), [](const LitScene& s) { return s.name == "two-triangles"; });
    Light& light = lit.parts.lights.at(0).at(0);
    light.position = {random.real(-2, 2), std::pow(10.0, random.in(-9, 9)), random.real(-2, 2)};
    light.falls_off = random.chance(0.5);
    if (random.chance(0.3)) {
      light.spot = true;
      light.direction = {0, -1, 0};
      light.outer_cosine = 1 - std::pow(10.0, random.in(-9, 0));
      light.inner_cosine = light.outer_cosine + (1 - light.outer_cosine) * random.real(0, 1);
    }
    const SceneFrame f = Scene::from(lit.parts).frame(0, 1);
    const Config c = smooth(f, 4);
    const FrameGeometry g = geometry(f, c, 1);
    CHECK(g.shades.size() <= std::size_t{2} * kWidth * kHeight);
    const FrameGeometry again = geometry(f, c, 1);
    std::vector<std::uint32_t> words;
    std::vector<std::uint32_t> words_again;
    make_frame(g, c, 0, words, {.threads = 1});
    make_frame(again, c, 0, words_again, {.threads = 4});
    CHECK(words == words_again);
  }
}
