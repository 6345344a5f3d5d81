// SPDX-License-Identifier: Apache-2.0
// Frames ask a configuration for nothing that no pixel shows. Judged by pictures with and without it, over random
// scenes and eyes; and lights that reach nothing, by their own formula.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/pipeline.hpp"
#include "oracle/light_reference.hpp"
#include "scene/view.hpp"
#include "stimulus/scenes/lit_scenes.hpp"
#include "stream/token_pieces.hpp"
#include "test/support/catch.hpp"

using namespace kage;

namespace {

constexpr int kWidth = 48;
constexpr int kHeight = 36;

struct Random {
  explicit Random(std::uint32_t seed) : engine(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  glm::dvec3 point(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
  std::mt19937 engine;
};

/// A parallelepiped.
SceneObject block(const glm::dvec3& at, const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& w) {
  SceneObject o;
  for (int i = 0; i < 8; ++i)
    o.positions.emplace_back(at + (i & 1) * 1.0 * u + (i >> 1 & 1) * 1.0 * v + (i >> 2) * 1.0 * w);
  o.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return o;
}

Camera looking(const glm::dvec3& from, const glm::dvec3& to, double near) {
  Camera c;
  c.eye = from;
  c.forward = glm::normalize(to - from);
  c.right = glm::normalize(glm::cross(c.forward, glm::dvec3{0.1, 1, 0.05}));
  c.up = glm::cross(c.right, c.forward);
  c.half_height = 0.6;
  c.near = near;
  return c;
}

/// All that a picture can have.
Config rich(int dsf_bits, int translucency, int channels) {
  Config c;
  c.x_bits = 8;
  c.max_width = 128;
  c.channels = channels;
  c.smooth = 1;
  c.color_frac = 8;
  c.dsf_bits = dsf_bits;
  c.fsf = dsf_bits > 0 ? 1 : 0;
  c.count_bits = dsf_bits > 0 ? 4 : 0;
  c.lights = dsf_bits > 0 ? 2 : 1;
  c.class_bits = dsf_bits > 0 ? 8 : 1;
  c.translucency = translucency;
  return c;
}

struct Drawn {
  std::vector<std::uint8_t> pixels;
  std::uint64_t panes = 0;  // TP tokens
};

Drawn drawn(const Scene& scene, const Config& config, int max_shading = 0) {
  Drawn out;
  Look look;
  look.fit = true;
  look.max_shading = max_shading;
  look.translucent = TranslucentWay::submission;
  std::vector<std::uint32_t> words;
  make_frame(make_geometry(scene.frame(0, 1), config, kWidth, kHeight, {.look = look}), config, 0, words,
             {.threads = 1});
  TokenPieces tokens(config);
  tokens.start();
  tokens.feed(words, [&](const Token& t) { out.panes += t.kind == Kind::TP ? 1 : 0; });
  GoldenCore core(config);
  core.frame(words, [&](int, std::span<const std::uint8_t> line) {
    out.pixels.insert(out.pixels.end(), line.begin(), line.end());
  });
  return out;
}

Light lamp(const glm::dvec3& at) { return verif::lamp(at, {4, 4, 4}); }

/// Pixels out of which light that would arrive is kept, by rays, and those that a hundredth of a pixel decides.
struct Rays {
  explicit Rays(const SceneFrame& frame) {
    const verif::RayScene rays(frame);
    const verif::LightReference reference(frame, rays, verif::sampled_points(frame, {}), kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const auto& p = truth.emplace_back(reference.pixel_with_ties(x, y, 0.01));
        any_shadow = any_shadow || (p.shadowed && !p.tie);
      }
  }

  std::vector<verif::ReferencePixel> truth;
  bool any_shadow = false;
};

/// The configuration that is taken for a picture without --config.
Config chosen(const Scene& scene) {
  DrawOptions draw;
  draw.width = kWidth;
  draw.height = kHeight;
  draw.frames = 1;
  return choose_config(scene, draw).config;
}

std::vector<std::uint32_t> words_of(const Drawn& d) {
  const std::size_t channels = d.pixels.size() / (std::size_t{kWidth} * kHeight);
  std::vector<std::uint32_t> words;
  for (std::size_t i = 0; i < d.pixels.size(); i += channels)
    words.push_back(d.pixels[i] | static_cast<std::uint32_t>(d.pixels[i + channels / 2]) << 8 |
                    static_cast<std::uint32_t>(d.pixels[i + channels - 1]) << 16);
  return words;
}

/// Whether pictures differ elsewhere than at ties.
bool differ(const Drawn& a, const Drawn& b, const Rays& rays) {
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (a.pixels[i] != b.pixels[i] && !rays.truth[i / 3].tie) return true;
  return false;
}

}  // namespace

TEST_CASE("a lone convex body asks for shadows only where its inner sides may be seen") {
  Random r(49);
  int none = 0;
  int some = 0;
  int inner = 0;
  double off = 0;
  std::uint64_t channels = 0;
  for (int round = 0; round < 300; ++round) {
    SceneParts parts;
    parts.objects = {block(r.point(0.5), r.point(1), r.point(1), r.point(1))};
    // Lights and eyes are near, far, and within. A ball's points may be on both sides of a face.
    const bool hard = round % 2 == 0;
    Light second = lamp(r.point(3));
    if (!hard) {
      second.shape = LightShape::sphere;
      second.axis_u = {r(0.1, 1), 0, 0};
    }
    parts.lights = {{lamp(r.point(2)), second}};
    parts.cameras = {looking(r.point(round % 3 == 0 ? 0.5 : 3), r.point(0.5), r(0.01, 0.5))};
    const Scene scene = Scene::from(parts);
    const SceneFrame frame = scene.frame(0, 1);
    const bool asked = needs_of(scene, frame, kWidth, kHeight).shadows;
    (asked ? some : none) += 1;
    const Rays rays(frame);
    inner += rays.any_shadow ? 1 : 0;
    CAPTURE(round);
    CHECK((asked || !rays.any_shadow));
    if (asked) continue;
    // Shares of a light whose points are on both sides of a face are rounded.
    if (hard) CHECK_FALSE(differ(drawn(scene, rich(4, 0, 3)), drawn(scene, rich(0, 0, 3)), rays));
    // The core that is taken for it shows the light that there is.
    const verif::LightError e =
        verif::compare_light(words_of(drawn(scene, chosen(scene), Look{}.max_shading)), rays.truth);
    off += e.lit_sum;
    channels += 3 * e.pixels;
  }
  CHECK(off / static_cast<double>(channels) < 1);
  CHECK(none > 60);
  CHECK(some > 60);
  CHECK(inner > 10);
}

TEST_CASE("a lone convex body asks for shadows where --cull shows its inside") {
  Random r(52);
  for (const bool inside_out : {false, true}) {
    SceneParts parts;
    SceneObject body = block({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2});
    parts.materials = {{.color = {0.5, 0.5, 0.5}, .double_sided = false}};
    body.materials.assign(12, 0);
    if (inside_out)
      for (auto& t : body.triangles) std::swap(t[1], t[2]);
    parts.objects = {body};
    parts.cameras = {looking({4, 3, 8}, {0, 0, 0}, 0.1)};
    const Scene scene = Scene::from(parts);
    CHECK(needs_of(scene, scene.frame(0, 1), kWidth, kHeight).shadows == inside_out);
  }
}

TEST_CASE("lights that come later ask for what they take") {
  SceneParts parts;
  parts.objects = {block({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}),
                   block({-3, -3, -3}, {6, 0, 0}, {0, 0.5, 0}, {0, 0, 6})};
  parts.cameras = {looking({4, 5, 8}, {0, 0, 0}, 0.1)};
  Light red = lamp({0, 4, 0});
  red.color = {1, 0.1, 0.1};
  Light soft = lamp({2, 4, 0});
  soft.shape = LightShape::sphere;
  soft.axis_u = {0.5, 0, 0};
  parts.lights = {{lamp({0, 4, 0})}, {red}, {lamp({0, 4, 0}), lamp({1, 4, 1}), soft}};
  const Scene scene = Scene::from(parts);
  const Needs first = needs_of(scene, scene.frame(0, 3), kWidth, kHeight);
  CHECK((first.lights == 1 && first.samples == 1 && !first.color));
  const Needs all = needs_of_frames(scene, 3, kWidth, kHeight);
  CHECK((all.lights == 3 && all.samples > 1 && all.color));
}

TEST_CASE("a pane and a colour ask for nothing where they are out of view") {
  Random r(50);
  int panes = 0;
  int no_panes = 0;
  int grey = 0;
  for (int round = 0; round < 300; ++round) {
    SceneParts parts;
    parts.materials = {{.color = {0.5, 0.5, 0.5}}, {.color = {0.7, 0.7, 0.7}, .alpha = 0.5}, {.color = {1, 0.2, 0.2}}};
    for (std::uint32_t m = 0; m < 3; ++m) {
      parts.objects.push_back(block(r.point(4), r.point(1), r.point(1), r.point(1)));
      parts.objects.back().materials.assign(12, m);
    }
    parts.cameras = {looking(r.point(4), r.point(4), r(0.01, 1))};
    parts.cameras[0].perspective = round % 2 == 0;
    if (round % 2 != 0) parts.cameras[0].half_height = 2;
    const Scene scene = Scene::from(parts);
    const Needs needs = needs_of(scene, scene.frame(0, 1), kWidth, kHeight);
    CAPTURE(round);
    const Drawn all = drawn(scene, rich(4, 1, 3));
    CHECK_FALSE((!needs.translucency && all.panes > 0));
    if (!needs.translucency) CHECK(all.pixels == drawn(scene, rich(4, 0, 3)).pixels);
    panes += all.panes > 0 ? 1 : 0;
    no_panes += needs.translucency ? 0 : 1;
    if (needs.color) continue;
    ++grey;
    parts.materials[2].color = {0.5, 0.5, 0.5};
    CHECK(all.pixels == drawn(Scene::from(parts), rich(4, 1, 3)).pixels);
  }
  CHECK(panes > 50);
  CHECK(no_panes > 50);
  CHECK(grey > 50);
}

TEST_CASE("what one frame of several shows is asked for") {
  SceneParts parts;
  parts.materials = {{.color = {0.5, 0.5, 0.5}}, {.color = {0.7, 0.7, 0.7}, .alpha = 0.5}};
  parts.objects = {block({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}),
                   block({9, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2})};
  parts.objects[0].materials.assign(12, 0);
  parts.objects[1].materials.assign(12, 1);
  const Camera away = looking({0, 0, 8}, {-1, 0, 0}, 0.1);
  parts.cameras = {away, away, looking({0, 0, 8}, {10, 0, 0}, 0.1), looking({0, 0, 0.5}, {0, 0, -1}, 0.1)};
  const Scene scene = Scene::from(parts);
  const auto needs = [&](int frames) {
    parts.cameras.resize(static_cast<std::size_t>(frames), away);
    const Scene some = Scene::from(parts);
    return needs_of_frames(some, frames, kWidth, kHeight);
  };
  CHECK(needs_of_frames(scene, 4, kWidth, kHeight).shadows);
  CHECK(needs_of_frames(scene, 4, kWidth, kHeight).translucency);
  CHECK(needs(3).translucency);
  CHECK_FALSE(needs(3).shadows);
  CHECK_FALSE(needs(2).translucency);
  CHECK_FALSE(needs(2).shadows);
}

TEST_CASE("a light that may not reach a ball gives nothing to any point of it") {
  Random r(51);
  int dark = 0;
  for (int round = 0; round < 2000; ++round) {
    const scene::Bounds ball{r.point(2), r(0.1, 3)};
    Light l = lamp(r.point(12));
    if (round % 2 == 0) l.range = r(0.1, 20);
    l.spot = round % 3 == 0;
    l.direction = glm::normalize(r.point(1) + glm::dvec3{0.001, 0, 0});
    l.outer_cosine = std::cos(r(0.05, 1.5));
    l.inner_cosine = 1;
    if (scene::may_reach(l, ball)) continue;
    ++dark;
    CAPTURE(round);
    for (int i = 0; i < 50; ++i) {
      glm::dvec3 at = r.point(1);
      at = ball.center + ball.radius * (i % 2 == 0 ? glm::normalize(at) : at * 0.5);
      const glm::dvec3 way = at - l.position;
      const bool beyond = l.range > 0 && glm::length(way) >= l.range;
      const bool outside = l.spot && glm::dot(glm::normalize(way), l.direction) <= l.outer_cosine;
      CHECK((beyond || outside));
    }
  }
  CHECK(dark > 300);
}

TEST_CASE("lights that reach nothing take no place") {
  SceneParts parts;
  parts.objects = {block({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2})};
  parts.cameras = {looking({0, 0, 8}, {0, 0, 0}, 0.1)};
  Light far = lamp({100, 0, 0});
  far.range = 50;
  Light black = lamp({0, 5, 0});
  black.color = {0, 0, 0};
  parts.lights = {{far, lamp({0, 5, 5}), black}};
  const Scene scene = Scene::from(parts);
  REQUIRE(scene.frame(0, 1).lights.size() == 1);
  CHECK(scene.frame(0, 1).lights[0].position.y == 5);
  CHECK(std::count(scene.notes().begin(), scene.notes().end(), "2 lights reach nothing: left out") == 1);
  parts.lights = {{far, black}};
  CHECK(Scene::from(parts).frame(0, 1).lights.size() == 1);
}
