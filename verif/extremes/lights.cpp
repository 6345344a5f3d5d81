// SPDX-License-Identifier: Apache-2.0
#include "extremes/lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "kage/core.hpp"
#include "kage/light.hpp"
#include "oracle/light_reference.hpp"
#include "oracle/light_truth.hpp"
#include "plan/widths.hpp"
#include "stimulus/shapes.hpp"

namespace kage::verif {
namespace {

constexpr int kLine = 40;

/// A unit vector, or `otherwise` if there is no direction.
glm::dvec3 direction_of(double x, double y, double z, const glm::dvec3& otherwise) {
  const double n = x * x + y * y + z * z;
  return n > 1e-6 ? glm::dvec3(x, y, z) / std::sqrt(n) : otherwise;
}

std::vector<std::uint8_t> golden_line(const Config& c, const std::vector<std::uint32_t>& words) {
  std::vector<std::uint8_t> pixels;
  const FrameStatus status = GoldenCore(c).frame(
      words, [&](int, std::span<const std::uint8_t> p) { pixels.insert(pixels.end(), p.begin(), p.end()); });
  if (status.error != ErrorCode::NONE) throw std::runtime_error("the golden core refuses the frame");
  return pixels;
}

}  // namespace

// ---- 29

void SamplesCase::Sample::fields(Fields& f) {
  f.number("left", left, 0, kLine);
  f.number("right", right, left, kLine, kLine);
  f.number("light", light, 0, 7);
}

void SamplesCase::fields(Fields& f) {
  f.number("bits", bits, 1, 8, 1);
  f.flag("fsf", fsf);
  f.number("class_bits", class_bits, 2, 11, 2);
  f.number("lights", lights, 1, 8, 1);
  f.number("equal", equal, 0, 255);
  f.number("share", share, 1, 4000, 256);
  f.list("sample", samples, 0, 60);
}

std::vector<LightSample> SamplesCase::all() const {
  std::vector<LightSample> all(static_cast<std::size_t>(equal), LightSample{7, 30, 0});
  for (const Sample& s : samples) all.push_back({s.left, s.right, s.light % lights});
  return all;
}

std::vector<std::uint32_t> SamplesCase::shares(const Config& config) const {
  std::vector<std::uint32_t> shares;
  for (int l = 0; l < config.lights; ++l)
    shares.push_back(static_cast<std::uint32_t>(std::min(share + share / 2 * l, 1 << config.shade_frac)));
  return shares;
}

Outcome SamplesCase::check(const Context& context) const {
  Config c;
  c.channels = 1;
  c.shade_frac = 16;
  c.fsf = fsf ? 1 : 0;
  c.count_bits = bits;
  c.max_width = kLine;
  c.class_bits = class_bits;
  c.lights = lights;
  std::vector<LightSample> order = all();
  const auto parts = shares(c);
  Outcome o;
  auto pixels = golden_line(c, light_frame(c, kLine, order, parts));
  context.spoil(pixels);
  for (int x = 0; x < kLine; ++x)
    if (pixels[static_cast<std::size_t>(x)] != light_pixel(c, x, order, parts))
      o.fail(fmt::format("pixel {} is {}, not {}", x, pixels[static_cast<std::size_t>(x)],
                         light_pixel(c, x, order, parts)));
  std::reverse(order.begin(), order.end());
  if (golden_line(c, light_frame(c, kLine, order, parts)) != pixels)
    o.fail("samples in another order give another line");
  o.pixels = kLine;
  return o;
}

void LitSceneCase::Lamp::fields(Fields& f) {
  lamp.fields(f);
  f.choice("shape", shape, std::array{"point", "disc", "rectangle", "sphere"});
  f.real("size", size, 0.05, 1.5, 0.5);
  turn.fields(f);
  f.flag("falls_off", falls_off);
}

void LitSceneCase::fields(Fields& f) {
  f.number("samples", samples, 1, 15, 1);
  f.number("seed", seed, 0, 1000);
  f.flag("smooth", smooth);
  f.list("lamp", lamps, 1, 4);
  scene.fields(f);
}

Outcome LitSceneCase::check(const Context& context) const {
  constexpr int kWidth = 48;
  constexpr int kHeight = 36;
  SceneFrame f = scene.frame();
  f.lights.clear();
  for (const Lamp& l : lamps) {
    Light light;
    l.lamp.apply_to(light);
    light.color = {0.9, 0.6, 0.3};
    light.falls_off = l.falls_off && !light.directional;
    if (light.falls_off) light.color *= 10.0;
    if (!light.directional) {
      light.shape = static_cast<LightShape>(l.shape);
      const Turn t = l.turn.turn();
      light.axis_u = light.shape == LightShape::sphere ? glm::dvec3(l.size, 0, 0) : t.x * l.size;
      light.axis_v = t.y * l.size;
    }
    f.lights.push_back(light);
  }
  Look look = scene.look();
  look.samples = samples;
  look.seed = static_cast<std::uint64_t>(seed);
  Config c;
  c.smooth = smooth ? 1 : 0;
  c.color_frac = 6 * c.smooth;
  c = config_for_lights(f, samples, c);
  const FrameGeometry g = make_geometry(f, c, kWidth, kHeight, {.look = look});
  const auto expected = expected_picture(g, c);
  auto got = draw(g, c);
  context.spoil(got);
  Outcome o;
  for (std::size_t i = 0; i < got.size(); ++i)
    if (got[i] != expected[i])
      o.fail(fmt::format("pixel ({}, {}) is {:06x}, not {:06x}", i % kWidth, i / kWidth, got[i], expected[i]));
  o.pixels = got.size();
  return o;
}

// ---- 30

void TableCase::Sun::fields(Fields& f) {
  f.real("x", x, -1, 1);
  f.real("y", y, -1, 1, -1);
  f.real("z", z, -1, 1);
  f.real("red", red, 0, 1, 1);
  f.real("green", green, 0, 1, 1);
  f.real("blue", blue, 0, 1, 1);
}

void TableCase::fields(Fields& f) {
  f.real("normal_x", x, -1, 1);
  f.real("normal_y", y, -1, 1, 1);
  f.real("normal_z", z, -1, 1);
  f.list("sun", suns, 1, 8);
}

namespace {

/// A white triangle with this normal, turned to the eye, and the suns; of several, each has its part of the light.
SceneFrame face_under_suns(const glm::dvec3& normal, const std::vector<TableCase::Sun>& suns) {
  SceneFrame f;
  const glm::dvec3 u =
      glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 v = glm::cross(normal, u);
  f.vertices = {u, -0.5 * u + v, -0.5 * u - v};
  f.shading = {{normal, {1, 1, 1}}};
  f.triangles = {{.vertex = {0, 1, 2}}};
  f.polygons = {{.first = 0, .count = 3, .triangle = 0}};
  f.corners = {0, 1, 2};
  Component& part = f.components.emplace_back();
  part.count = part.polygon_count = 1;
  f.lights.clear();
  for (const TableCase::Sun& s : suns) {
    Light& l = f.lights.emplace_back();
    l.direction = direction_of(s.x, s.y, s.z, {0, -1, 0});
    l.color = glm::dvec3(s.red, s.green, s.blue) / static_cast<double>(suns.size());
  }
  look_at(f.camera, 5.0 * normal, {0, 0, 0});
  return f;
}

}  // namespace

// docs/lights.md, "How far a table is off": whichever lights are out, the entry takes what they gave, but for what all
// of them together take more than one by one. On top come the rounding of each share and the encoding, which is 0.017
// of a step off at most, twice for each difference of two colours.
Outcome TableCase::check(const Context& context) const {
  constexpr double kEncoding = 0.017;
  const SceneFrame f = face_under_suns(direction_of(x, y, z, {0, 1, 0}), suns);
  Config config;
  config.count_bits = 1;
  config.lights = std::max(2, static_cast<int>(suns.size()));
  config.class_bits = 11;
  config.shade_frac = 16;
  const FrameGeometry g = make_geometry(f, config, 16, 16);
  Outcome o;
  if (g.drawn != 1 || g.polygons[0].normal_class == 0) return o;
  const glm::dvec3& normal = f.shading[0].normal;
  const double ambient = kReferenceAmbient + kReferenceSky * 0.5 * (1 + glm::dot(normal, f.camera.up));
  const auto n = f.lights.size();
  const std::size_t first = (g.polygons[0].normal_class - 1) * static_cast<std::size_t>(config.lights);
  for (int c = 0; c < 3; ++c) {
    std::vector<double> arrives;
    for (const Light& l : f.lights) arrives.push_back((1 - kReferenceAmbient) * reference_arrives(l, l, {}, normal)[c]);
    const auto color = [&](unsigned out) {
      double light = ambient;
      for (std::size_t l = 0; l < n; ++l) light += (out >> l & 1U) != 0 ? 0 : arrives[l];
      return 255 * reference_encode(light);
    };
    const unsigned all = (1U << n) - 1;
    const double direct = std::accumulate(arrives.begin(), arrives.end(), 0.0);
    double together = color(0) - color(all);
    for (std::size_t l = 0; l < n; ++l) together -= color(0) - color(1U << l);
    for (unsigned state = 0; state <= all; ++state) {
      double taken = 0;
      double stated = 0;  // each light's own loss, and its part of a quarter of what they take together
      for (std::size_t l = 0; l < n; ++l) {
        if ((state >> l & 1U) == 0) continue;
        taken += g.shares[first + l][static_cast<std::size_t>(c)] / 65536.0;
        stated += color(0) - color(1U << l) + (direct > 0 ? together / 4 * (arrives[l] / direct) : 0);
      }
      if (context.injected(Injection::large_share)) taken *= 65.0 / 64;
      const auto lights = static_cast<double>(n);
      const double rounding = lights * 255 * 0x1p-17 + 4 * (lights + 1) * kEncoding;
      if (std::abs(color(0) * taken - stated) > rounding)
        o.fail(fmt::format("state {}: the entry takes {} of {}, not {}", state, color(0) * taken, color(0), stated));
      o.measure(std::abs(color(0) * (1 - taken) - color(state)),
                together + lights * 255 * 0x1p-17 + 2 * (lights + 1) * kEncoding);
    }
  }
  o.items += std::uint64_t{3} << n;
  return o;
}

void PassesCase::fields(Fields& f) {
  f.number("bits", bits, 10, 14, 12);
  f.list("sun", suns, 1, 8);
  scene.fields(f, 1, 4);
}

// docs/plan.md, "Light after light". No span changes its colour here. So a pixel is off by the rounding of each light,
// and of the light from everywhere, to the pixel's bits, where the curve is steepest, and by that of the display.
Outcome PassesCase::check(const Context& context) const {
  constexpr int kWidth = 40;
  constexpr int kHeight = 30;
  SceneFrame f = scene.frame();
  f.lights.clear();
  for (const TableCase::Sun& s : suns) {
    Light& l = f.lights.emplace_back();
    l.direction = direction_of(s.x, s.y, s.z, {0, -1, 0});
    l.color = glm::dvec3(s.red, s.green, s.blue) / static_cast<double>(suns.size());
  }
  Config c;
  c.linear_bits = bits;
  c.smooth = 1;
  c.color_frac = bits - 8;
  const Look look = scene.look();
  auto got = draw(make_geometry(f, c, kWidth, kHeight, {.look = look}), c);
  context.spoil(got);
  const RayScene rays(f);
  std::vector<std::vector<LightPoint>> points;
  for (const Light& l : f.lights) points.push_back({l});
  const LightReference reference(f, rays, std::move(points), kWidth, kHeight);
  // A snap moves what a pixel shows by half of its step.
  const double off = std::ldexp(1.0, -look.sub_bits) * 2;
  const double bound = 0.5 + plan::linear_error(static_cast<double>(suns.size()), 0, 0, bits, c.color_frac);
  Outcome o;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const ReferencePixel p = reference.pixel_with_ties(x, y, off);
      if (p.tie || p.face == kNothing) continue;
      ++o.pixels;
      for (int k = 0; k < 3; ++k)
        o.measure(std::abs((got[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] >> (8 * k) & 255U) -
                           p.color[k]),
                  bound);
    }
  return o;
}

void add_light_families(Families& to) {
  add_family<SamplesCase>(to, {29, "29", "samples of lights: what a counter holds, and more, in any order"});
  add_family<LitSceneCase>(to, {29, "29 frames", "pictures of several lights and samples from hard shadows alone"});
  add_family<TableCase>(to, {30, "30", "what a table takes of a face, in every state of shadow", "LSB", 400});
  add_family<PassesCase>(to,
                         {30, "30 passes", "pictures of several suns by light after light, at each pixel", "LSB", 40});
}

}  // namespace kage::verif
