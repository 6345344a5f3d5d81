// SPDX-License-Identifier: Apache-2.0
#include "extremes/lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "kage/core.hpp"
#include "kage/light.hpp"
#include "oracle/light_truth.hpp"

namespace kage::verif {
namespace {

constexpr int kLine = 40;

/// A unit vector, or `otherwise` if there is no direction.
glm::dvec3 direction_of(double x, double y, double z, const glm::dvec3& otherwise) {
  const double n = x * x + y * y + z * z;
  return n > 1e-6 ? glm::dvec3(x, y, z) / std::sqrt(n) : otherwise;
}

/// Classes of normals take long to make; there are few counts of them.
const NormalClasses& classes_of(int count) {
  static std::mutex mutex;
  static std::map<int, NormalClasses> made;
  const std::scoped_lock lock(mutex);
  return made.try_emplace(count, count).first->second;
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
  f.number("classes_log", classes_log, 3, 10, 3);
  f.real("normal_x", x, -1, 1);
  f.real("normal_y", y, -1, 1, 1);
  f.real("normal_z", z, -1, 1);
  f.list("sun", suns, 1, 8);
}

TableFrame::TableFrame(std::vector<Light> suns, int classes)
    : lights_(std::move(suns)),
      samples_(lights_.size(), 1),
      lighting_(lights_, {0, 1, 0}),
      count_(std::max<std::size_t>(2, lights_.size())) {
  config_.count_bits = 1;
  config_.lights = static_cast<int>(count_);
  config_.class_bits = 11;
  config_.shade_frac = 16;
  look_.classes = classes;
  table_.emplace(config_, look_, lights_, lighting_, samples_);
}

bool TableFrame::add(const glm::dvec3& normal) {
  std::bitset<kMaxLights> reach;
  for (std::size_t l = 0; l < lights_.size(); ++l) reach[l] = glm::dot(normal, lights_[l].direction) < 0;
  if (reach.none()) return false;
  g_.polygons.emplace_back().normal_class = table_->classify(normal, {}, 1, reach);
  faces_.push_back({normal, reach});
  return true;
}

void TableFrame::finish() { table_->finish(g_); }

// docs/lights.md, "How far a table is off". By a class, the loss to the shadowed lights is off by at most k (W + 0.04)
// r and a rounding for each light. W is the weight of all lights, and k the steepest slope of the loss.
void TableFrame::measure(std::size_t face, double off_class, Outcome& o, const Context& context) const {
  const double steepest = (srgb_encode(0.2 + 1e-6) / srgb_encode(0.2) - 1) / 1e-6;
  constexpr double kAmbientWeight = 0.04;
  const auto& [normal, reach] = faces_[face];
  const auto exact = lighting_.shares({}, normal, reach, false);
  const glm::dvec3 white = lighting_.displayed({}, normal, {1, 1, 1}, reach, false);
  const std::size_t first = (g_.polygons[face].normal_class - 1) * count_;
  for (unsigned state = 0; state < 1U << lights_.size(); ++state)
    for (int c = 0; c < 3; ++c) {
      double got = 0;
      double right = 0;
      double weight = 0;
      for (std::size_t l = 0; l < lights_.size(); ++l) {
        weight += 0.8 * lights_[l].color[c];
        if ((state >> l & 1U) == 0) continue;
        right += exact[l][c];
        got += g_.shares[first + l][static_cast<std::size_t>(c)] / 65536.0;
      }
      if (context.injected(Injection::large_share)) got *= 65.0 / 64;
      o.measure(white[c] * std::abs(got - right), white[c] * (steepest * (weight + kAmbientWeight) * off_class +
                                                              static_cast<double>(lights_.size()) * 0x1p-17));
    }
  o.items += std::uint64_t{3} << lights_.size();
}

Outcome TableCase::check(const Context& context) const {
  std::vector<Light> lights;
  for (const Sun& s : suns) {
    Light l;
    l.direction = direction_of(s.x, s.y, s.z, {0, -1, 0});
    l.color = glm::dvec3(s.red, s.green, s.blue) / static_cast<double>(suns.size());
    lights.push_back(l);
  }
  const int classes = 1 << classes_log;
  TableFrame frame(std::move(lights), classes);
  Outcome o;
  const glm::dvec3 n = direction_of(x, y, z, {0, 1, 0});
  if (!frame.add(n)) return o;
  frame.finish();
  const NormalClasses& of = classes_of(classes);
  const glm::dvec3 off_class = n - of.normal(of.nearest(n));
  frame.measure(0, std::sqrt(glm::dot(off_class, off_class)), o, context);
  return o;
}

void add_light_families(Families& to) {
  add_family<SamplesCase>(to, {29, "29", "samples of lights: what a counter holds, and more, in any order"});
  add_family<LitSceneCase>(to, {29, "29 frames", "pictures of several lights and samples from hard shadows alone"});
  add_family<TableCase>(to, {30, "30", "what lights give to a normal and to its class", "LSB", 400});
}

}  // namespace kage::verif
