// SPDX-License-Identifier: Apache-2.0
#include "trade/sweep_scene.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arena/arena.hpp"
#include "contract/derived.hpp"
#include "cosim/model/sha256.hpp"
#include "kage/light.hpp"
#include "opinion/ray_truth.hpp"
#include "plan/demand.hpp"
#include "trade/kept.hpp"

namespace kage::trade {
namespace {

// Tests of a ray with a face that a frame's rays may take, some 2 ns each: a few seconds on a processor.
constexpr double kMostTests = 2e9;

template <class T>
void add(cosim::Sha256& hash, const std::vector<T>& values) {
  hash.add(static_cast<std::uint64_t>(values.size()));
  hash.add_piece(std::span<const T>(values));
}

/// The frame without its translucent faces: rays are asked about what is behind them.
SceneFrame opaque_only(SceneFrame f) {
  for (Polygon& p : f.polygons)
    if (f.triangles[p.triangle].alpha != 255) p.count = 0;
  return f;
}

RayPixel ray_pixel(const SceneFrame& f, const verif::RayScene& rays, const SweepPoint& point, int x, int y) {
  RayPixel out{.x = x, .y = y};
  const auto [origin, direction] = verif::pixel_ray(f.camera, x, y, point.width, point.height);
  const auto [t, face] = rays.nearest(origin, direction, f.camera.near);
  if (face == verif::kNothing) return out;
  out.face = face;
  const Light& light = f.lights[0];
  const glm::dvec3 at = origin + t * direction;
  const glm::dvec3 to_light = light.directional ? -light.direction : light.position - at;
  out.shadowed = rays.blocked(at, to_light, light.directional ? INFINITY : 1, face);
  return out;
}

}  // namespace

std::string_view name_of(ErrorSource source) {
  constexpr std::array<std::string_view, kErrorSources.size()> kNames{"snapping", "depth",   "color",
                                                                      "samples",  "classes", "order"};
  return kNames[static_cast<std::size_t>(source)];
}

struct SweepScene::Data {
  std::shared_ptr<const Scene> scene;
  DrawOptions draw;
  std::function<void()> step;
  plan::Features features;
  bool table = false;
  int channels = 1;
  Kept<SceneFrame> frames;
  Kept<std::string> identity;
  Kept<ScreenTruth> truths;
  Kept<DrawnFrame> pictures;
  Kept<std::vector<RayPixel>> rays;
  Kept<PictureError> errors;
};

SweepScene::SweepScene(std::shared_ptr<const Scene> scene, const DrawOptions& draw, const SweepPoint& base,
                       std::function<void()> step)
    : data_(std::make_unique<Data>()) {
  Data& d = *data_;
  d.scene = std::move(scene);
  d.draw = draw;
  d.step = std::move(step);
  PlannedScene planned{d.scene, draw};
  planned.draw.width = base.width;
  planned.draw.height = base.height;
  planned.draw.look.samples = kMaxSamples;
  d.features = plan::features_of(std::span(&planned, 1));
  d.table = derived::has_table(base.config);
  d.channels = base.config.channels;
}

SweepScene::~SweepScene() = default;

const std::string& SweepScene::name() const { return data_->draw.name; }
int SweepScene::frames() const { return data_->draw.frames; }
const SceneFrame& SweepScene::frame(int index) const {
  return *data_->frames.get(fmt::format("{} ", index), [&] {
    data_->step();
    return data_->scene->frame(index, frames());
  });
}
const std::shared_ptr<const Scene>& SweepScene::scene() const { return data_->scene; }
const std::string& SweepScene::identity() const {
  return *data_->identity.get("", [&] {
    cosim::Sha256 hash;
    for (int i = 0; i < frames(); ++i) {
      const SceneFrame& f = frame(i);
      add(hash, f.vertices);
      add(hash, f.corners);
      const Camera& c = f.camera;
      add(hash, std::vector<glm::dvec3>{c.eye, c.right, c.up, c.forward, {c.near, c.half_height, c.perspective}});
    }
    return hash.take();
  });
}

DrawOptions SweepScene::draw_options(const SweepPoint& point) const {
  DrawOptions draw = data_->draw;
  draw.width = point.width;
  draw.height = point.height;
  draw.look = point.look;
  return draw;
}

SweepPoint SweepScene::finest(const SweepPoint& point) const {
  SweepPoint out = point;
  plan::Features features = data_->features;
  features.needs.width = point.width;
  // Parity is right for any caster.
  out.config = plan::finest(features, features.needs.shadows ? 1 : 0, 0);
  out.config.z_bits = kGreatest.z_bits;
  // A scene whose faces are all grey has a background that is not.
  out.config.channels = std::max(out.config.channels, data_->channels);
  if (data_->table && out.config.dsf_bits > 0) {
    out.config.count_bits = kGreatest.count_bits;
    out.config.class_bits = kGreatest.class_bits;
  }
  out.look.sub_bits = kMostSubBits;
  out.look.samples = kMaxSamples;
  out.look.classes = kMaxClasses;
  out.look.translucent = TranslucentWay::exact;
  return out;
}

SweepPoint SweepScene::alone(const SweepPoint& point, ErrorSource source) const {
  SweepPoint out = finest(point);
  Config& c = out.config;
  const Config& of = point.config;
  switch (source) {
    case ErrorSource::snapping:
      out.look.sub_bits = point.look.sub_bits;
      break;
    case ErrorSource::depth:
      c.z_bits = of.z_bits;
      c.z_frac = of.z_frac;
      break;
    case ErrorSource::color:
      c.channels = std::min(c.channels, of.channels);
      c.smooth = std::min(c.smooth, of.smooth);
      c.color_frac = c.smooth > 0 ? of.color_frac : 0;
      c.shade_frac = of.shade_frac;
      break;
    case ErrorSource::samples:
      if (c.dsf_bits == 0) break;
      c.dsf_bits = of.dsf_bits;
      c.fsf = of.fsf;
      c.count_bits = std::min(c.count_bits, of.count_bits);
      c.lights = std::min(c.lights, of.lights);
      out.look.samples = point.look.samples;
      out.look.seed = point.look.seed;
      break;
    case ErrorSource::classes:
      c.class_bits = std::min(c.class_bits, of.class_bits);
      out.look.classes = point.look.classes;
      break;
    case ErrorSource::order:
      c.translucency = std::min(c.translucency, of.translucency);
      out.look.translucent = point.look.translucent;
      break;
  }
  for (const RuleInfo& rule : kRules)
    if (!rule.holds(c)) rule.repair(c);
  return out;
}

std::vector<int> SweepScene::light_samples(int index, const SweepPoint& point) const {
  std::vector<int> out;
  for (const Light& light : frame(index).lights)
    out.push_back(light.shape == LightShape::point ? 1 : samples_of(point));
  return out;
}

std::shared_ptr<const ScreenTruth> SweepScene::truth(int index, const SweepPoint& point, int sub_bits) {
  SweepPoint p = finest(point);
  p.look.sub_bits = sub_bits;
  p.look.samples = samples_of(point);
  p.look.seed = point.look.seed;
  return data_->truths.get(fmt::format("{} {}", index, text_of(p)), [&] {
    data_->step();
    const FrameGeometry g = make_geometry(frame(index), p.config, p.width, p.height, {.look = p.look});
    return screen_truth(g, p.config, data_->draw.threads);
  });
}

std::shared_ptr<const DrawnFrame> SweepScene::finest_picture(int index, const SweepPoint& point) {
  SweepPoint p = finest(point);
  p.look.seed = 1;  // the truth has one pattern
  return data_->pictures.get(fmt::format("{} {}", index, text_of(p)), [&] {
    data_->step();
    return draw(frame(index), p.config, draw_options(p));
  });
}

std::shared_ptr<const std::vector<RayPixel>> SweepScene::rays(int index, const SweepPoint& point) {
  return data_->rays.get(fmt::format("{} {}x{}", index, point.width, point.height), [&] {
    data_->step();
    const SceneFrame f = opaque_only(frame(index));
    const verif::RayScene scene(f);
    int step = 1;
    while (2.0 * point.width * point.height * static_cast<double>(f.triangles.size()) / (step * step) > kMostTests)
      ++step;
    std::vector<RayPixel> out;
    for (int y = step / 2; y < point.height; y += step)
      for (int x = step / 2; x < point.width; x += step) out.push_back({.x = x, .y = y});
    Arena arena(data_->draw.threads);
    arena.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), 256), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          out[i] = ray_pixel(f, scene, point, out[i].x, out[i].y);
      });
    });
    return out;
  });
}

namespace {

/// A point as its error by a source is measured: the finest picture has one pattern of samples.
SweepPoint alone_in(const SweepScene& scene, const SweepPoint& point, ErrorSource source) {
  SweepPoint p = scene.alone(point, source);
  if (source != ErrorSource::samples) p.look.seed = 1;
  return p;
}

}  // namespace

ErrorMap SweepScene::map_of(int index, const SweepPoint& point, ErrorSource source) {
  const SweepPoint p = alone_in(*this, point, source);
  const auto expected = finest_picture(index, point);
  SweepPoint best = finest(point);
  best.look.seed = 1;
  if (text_of(p) == text_of(best))
    return {.width = p.width, .height = p.height, .pixels = std::vector<PixelError>(expected->face.size())};
  data_->step();
  const DrawnFrame drawn = draw(frame(index), p.config, draw_options(p));
  return against_picture(*expected, light_samples(index, best), drawn, light_samples(index, p));
}

std::shared_ptr<const PictureError> SweepScene::error_of(int index, const SweepPoint& point, ErrorSource source) {
  return data_->errors.get(fmt::format("{} {}", index, text_of(alone_in(*this, point, source))),
                           [&] { return sum_of(map_of(index, point, source)); });
}

void SweepScene::forget(int index) {
  const std::string begin = fmt::format("{} ", index);
  data_->frames.forget(begin);
  data_->truths.forget(begin);
  data_->pictures.forget(begin);
  data_->rays.forget(begin);
  data_->errors.forget(begin);
}

}  // namespace kage::trade
