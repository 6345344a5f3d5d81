// SPDX-License-Identifier: Apache-2.0
#include "explore/sweep_scene.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <utility>

#include "arena/arena.hpp"
#include "contract/derived.hpp"
#include "cosim/model/sha256.hpp"
#include "explore/kept.hpp"
#include "kage/light.hpp"
#include "oracle/light_reference.hpp"
#include "oracle/ray_truth.hpp"
#include "plan/demand.hpp"

namespace kage::explore {
namespace {

// Rays are spent as if each were tested with every face, 2 ns a test, for a few seconds on a processor. A tree of boxes
// spares most of the tests, so a large scene takes less.
constexpr double kMostTests = 2e9;

// Where rays so much of a pixel beside its middle see something else, the snap may decide.
constexpr double kSnapped = 1.0 / 128;

template <class T>
void add(cosim::Sha256& hash, const std::vector<T>& values) {
  hash.add(static_cast<std::uint64_t>(values.size()));
  hash.add_piece(std::span<const T>(values));
}

void add(cosim::Sha256& hash, std::initializer_list<double> numbers) {
  hash.add_piece(std::span<const double>(numbers.begin(), numbers.size()));
}

void add(cosim::Sha256& hash, const glm::dvec3& v) { add(hash, {v.x, v.y, v.z}); }

/// All of a frame that pictures, shadows or rays depend on. A feature that a core lacks is in no word of its own, and
/// yet shows in the finest picture: a translucent face's alpha, a light's size.
void add(cosim::Sha256& hash, const SceneFrame& f) {
  add(hash, f.vertices);
  add(hash, f.corners);
  const Camera& c = f.camera;
  for (const glm::dvec3& v : {c.eye, c.right, c.up, c.forward}) add(hash, v);
  add(hash, {c.near, c.half_height, c.perspective ? 1.0 : 0.0});
  hash.add(static_cast<std::uint64_t>(f.lights.size()));
  for (const Light& l : f.lights) {
    for (const glm::dvec3& v : {l.direction, l.position, l.color, l.axis_u, l.axis_v}) add(hash, v);
    add(hash, {l.directional ? 1.0 : 0.0, l.falls_off ? 1.0 : 0.0, l.range, l.spot ? 1.0 : 0.0, l.inner_cosine,
               l.outer_cosine, static_cast<double>(l.shape)});
  }
  hash.add(static_cast<std::uint64_t>(f.shading.size()));
  for (const ShadingVertex& v : f.shading) {
    add(hash, v.normal);
    add(hash, v.color);
  }
  hash.add(static_cast<std::uint64_t>(f.triangles.size()));
  for (const Triangle& t : f.triangles) {
    hash.add_piece(std::span<const std::uint32_t>(t.vertex));
    hash.add_piece(std::span<const std::uint32_t>(t.shading));
    const std::array<std::uint8_t, 3> look{t.alpha, static_cast<std::uint8_t>(t.unlit ? 1 : 0),
                                           static_cast<std::uint8_t>(t.sides)};
    hash.add_piece(std::span<const std::uint8_t>(look));
  }
  hash.add(static_cast<std::uint64_t>(f.polygons.size()));
  for (const Polygon& p : f.polygons) {
    const std::array<std::uint32_t, 3> polygon{p.first, p.count, p.triangle};
    hash.add_piece(std::span<const std::uint32_t>(polygon));
  }
}

// Two faces are at one distance from the eye where rounding may decide.
constexpr double kOneDistance = 1e-9;

/// The frame without its translucent faces, or without the others.
SceneFrame only(SceneFrame f, bool opaque) {
  for (Polygon& p : f.polygons)
    if ((f.triangles[p.triangle].alpha == 255) != opaque) p.count = 0;
  return f;
}

/// A frame for rays.
struct RayFrame {
  RayFrame(const SceneFrame& f, const SweepPoint& point)
      : camera(f.camera),
        opaque(only(f, true)),
        behind(opaque),
        before(only(f, false)),
        width(point.width),
        height(point.height) {
    for (std::size_t l = 0; l < f.lights.size(); ++l)
      lights.push_back(light_points(f.lights[l], samples_of(point), point.look.seed + l));
  }

  /// Tests of rays with faces that a pixel's lights would take without a tree.
  [[nodiscard]] double light_tests() const {
    std::size_t points = 0;
    for (const auto& light : lights) points += light.size();
    return static_cast<double>(points * opaque.triangles.size());
  }

  Camera camera;
  SceneFrame opaque;
  verif::RayScene behind;
  verif::RayScene before;
  int width;
  int height;
  std::vector<std::vector<LightPoint>> lights;
};

/// Twice the area of a face, along its normal.
glm::dvec3 normal_of(const SceneFrame& f, std::uint32_t face) {
  const auto outline = f.outline(f.polygons[face]);
  glm::dvec3 sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < outline.size(); ++i)
    sum += glm::cross(f.vertices[outline[i]] - f.vertices[outline[0]],
                      f.vertices[outline[i + 1]] - f.vertices[outline[0]]);
  return sum;
}

void ask_lights(const RayFrame& f, const glm::dvec3& at, const glm::dvec3& direction, RayPixel& out) {
  const glm::dvec3 normal = normal_of(f.opaque, out.face);
  const double eye = -glm::dot(normal, direction);
  for (std::size_t l = 0; l < std::min(f.lights.size(), out.counts.size()); ++l) {
    int count = 0;
    bool lit = false;
    for (const LightPoint& point : f.lights[l]) {
      const glm::dvec3 to_light = point.directional ? -point.direction : point.position - at;
      const bool before = glm::dot(normal, to_light) * eye > 0;
      lit = lit || before;
      // From those behind it the face keeps itself.
      if (!before || f.behind.blocked(at, to_light, point.directional ? INFINITY : 1, out.face)) ++count;
    }
    if (lit) out.counts[l] = count;
  }
}

void ask_layers(const RayFrame& f, const glm::dvec3& origin, const glm::dvec3& direction, double end, RayPixel& out) {
  std::vector<std::pair<double, std::uint32_t>> met;
  f.before.meet(origin, direction, [&](double t, std::uint32_t face) {
    if (t >= f.camera.near && t < end) met.emplace_back(t, face);
  });
  std::sort(met.begin(), met.end(), std::greater<>());
  // On a diagonal of a face two of its triangles are met.
  met.erase(std::unique(met.begin(), met.end(), [](const auto& a, const auto& b) { return a.second == b.second; }),
            met.end());
  for (std::size_t i = 0; i + 1 < met.size(); ++i)
    if (met[i].first - met[i + 1].first < kOneDistance * met[i].first) return;
  for (const auto& [t, face] : met) out.layers.push_back(face);
}

RayPixel ray_pixel(const RayFrame& f, int x, int y, bool lights) {
  RayPixel out{.x = x, .y = y, .layers = {}};
  const auto [origin, direction] = verif::pixel_ray(f.camera, x, y, f.width, f.height);
  const auto [t, face] = f.behind.nearest(origin, direction, f.camera.near);
  ask_layers(f, origin, direction, t, out);
  if (face == verif::kNothing) return out;
  out.face = face;
  if (lights) ask_lights(f, origin + t * direction, direction, out);
  return out;
}

}  // namespace

std::string_view name_of(ErrorSource source) {
  constexpr std::array<std::string_view, kErrorSources.size()> kNames{"snapping", "depth",   "color", "shading",
                                                                      "samples",  "classes", "law",   "order"};
  return kNames[static_cast<std::size_t>(source)];
}

struct SweepScene::Data {
  std::shared_ptr<const Scene> scene;
  DrawOptions draw;
  std::function<void()> step;
  plan::Features features;
  Kept<SceneFrame> frames;
  Kept<std::string> identity;
  Kept<ScreenTruth> truths;
  Kept<DrawnFrame> pictures;
  Kept<std::vector<RayPixel>> rays;
  Kept<LightTruth> light;
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
  // A core that draws shadows where none are to be seen is held against a picture with shadows, too.
  const std::vector<Component>& parts = frame(0).components;
  d.features.needs.shadows = std::any_of(parts.begin(), parts.end(), [](const Component& c) { return !c.translucent; });
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
    for (int i = 0; i < frames(); ++i) add(hash, frame(i));
    return hash.take();
  });
}

const Needs& SweepScene::needs() const { return data_->features.needs; }

DrawOptions SweepScene::draw_options(const SweepPoint& point) const {
  DrawOptions draw = data_->draw;
  draw.width = point.width;
  draw.height = point.height;
  draw.look = point.look;
  return draw;
}

namespace {

/// The point with everything at its finest, light after light or by a table, which has room for the first 8 lights.
SweepPoint finest_by(plan::Features features, const SweepPoint& point, bool linear) {
  SweepPoint out = point;
  features.needs.width = point.width;
  if (!linear) features.needs.lights = std::min(features.needs.lights, kGreatest.lights);
  // Parity is right for any caster.
  const int dsf_bits = features.needs.shadows ? 1 : 0;
  out.config = plan::finest(features, {.dsf_bits = dsf_bits, .linear = linear}, 0);
  out.config.z_bits = kGreatest.z_bits;
  out.config.channels = kGreatest.channels;  // a grey scene has a background of another colour
  if (out.config.dsf_bits > 0) {
    out.config.count_bits = kGreatest.count_bits;
    if (out.config.linear_bits == 0) out.config.class_bits = kGreatest.class_bits;
  }
  out.look.sub_bits = kMostSubBits;
  out.look.samples = kMaxSamples;
  out.look.classes = kMaxClasses;
  out.look.max_shading = 1;
  out.look.translucent = TranslucentWay::exact;
  return out;
}

/// The finest picture has one pattern of samples.
SweepPoint one_pattern(SweepPoint p) {
  p.look.seed = 1;
  return p;
}

}  // namespace

SweepPoint SweepScene::finest(const SweepPoint& point) const { return finest_by(data_->features, point, true); }

SweepPoint SweepScene::finest_of_law(const SweepPoint& point) const {
  return finest_by(data_->features, point, point.config.linear_bits > 0);
}

SweepPoint SweepScene::alone(const SweepPoint& point, ErrorSource source) const {
  SweepPoint out = finest_of_law(point);
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
      if (c.smooth > 0 && of.smooth > 0) c.color_frac = of.color_frac;
      c.shade_frac = of.shade_frac;
      break;
    case ErrorSource::shading:
      c.smooth = std::min(c.smooth, of.smooth);
      if (c.smooth == 0) c.color_frac = 0;
      out.look.max_shading = point.look.max_shading;
      break;
    case ErrorSource::samples:
      out.look.samples = samples_of(point);
      out.look.seed = point.look.seed;
      if (c.dsf_bits == 0) break;
      c.dsf_bits = of.dsf_bits;
      c.fsf = of.fsf;
      c.count_bits =
          std::max(of.count_bits, 1);  // a table needs a counter, and one share for all is no matter of samples
      c.lights = std::min(c.lights, of.lights);
      break;
    case ErrorSource::classes:
      if (c.dsf_bits == 0 || c.linear_bits > 0) break;
      c.class_bits = of.class_bits;
      out.look.classes = point.look.classes;
      break;
    case ErrorSource::law:
      if (c.linear_bits > 0 && of.linear_bits > 0) c.linear_bits = of.linear_bits;
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
  SweepPoint p = finest_of_law(point);
  p.look.sub_bits = sub_bits;
  p.look.translucent = TranslucentWay::submission;  // layers change no answer, and their order takes long
  p.look.samples = samples_of(point);
  p.look.seed = point.look.seed;
  return data_->truths.get(fmt::format("{} {}", index, text_of(p)), [&] {
    data_->step();
    const FrameGeometry g = make_geometry(frame(index), p.config, p.width, p.height, {.look = p.look});
    return screen_truth(g, p.config, data_->draw.threads, data_->step);
  });
}

std::shared_ptr<const DrawnFrame> SweepScene::kept_picture(int index, const SweepPoint& point) {
  return data_->pictures.get(fmt::format("{} {}", index, text_of(point)), [&] {
    data_->step();
    return draw(frame(index), point.config, draw_options(point));
  });
}

std::shared_ptr<const DrawnFrame> SweepScene::finest_picture(int index, const SweepPoint& point) {
  return kept_picture(index, one_pattern(finest(point)));
}

std::shared_ptr<const LightTruth> SweepScene::light(int index, const SweepPoint& point) {
  return data_->light.get(fmt::format("{} {}x{}", index, point.width, point.height), [&] {
    data_->step();
    SweepPoint finest_samples = point;
    finest_samples.look.samples = kMaxSamples;
    finest_samples.look.seed = 1;
    finest_samples.config.count_bits = kGreatest.count_bits;
    const RayFrame f(frame(index), finest_samples);
    const verif::LightReference reference(f.opaque, f.behind, f.lights, f.width, f.height);
    const double pixels = static_cast<double>(point.width) * point.height;
    LightTruth out;
    int& step = out.step;
    constexpr double kRays = 5;  // of a pixel, with those that tell near ties
    while (kRays * pixels * (f.light_tests() + static_cast<double>(f.opaque.triangles.size())) / (step * step) >
           kMostTests)
      ++step;
    std::vector<LightPixel>& all = out.pixels;
    for (int y = step / 2; y < point.height; y += step)
      for (int x = step / 2; x < point.width; x += step) all.push_back({.x = x, .y = y});
    Arena arena(data_->draw.threads);
    arena.for_each(tbb::blocked_range<std::size_t>(0, all.size(), 64), [&](const auto& range) {
      data_->step();
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        RayPixel before{.layers = {}};
        const auto [origin, direction] = verif::pixel_ray(f.camera, all[i].x, all[i].y, f.width, f.height);
        ask_layers(f, origin, direction, INFINITY, before);
        const verif::ReferencePixel p = reference.pixel_with_ties(all[i].x, all[i].y, kSnapped);
        if (!before.layers.empty() || p.tie || p.face == verif::kNothing) continue;
        all[i].face = p.face;
        all[i].color = p.color;
        all[i].shadowed = p.shadowed;
      }
    });
    std::erase_if(all, [](const LightPixel& p) { return p.face == kNothing; });
    return out;
  });
}

std::shared_ptr<const std::vector<RayPixel>> SweepScene::rays(int index, const SweepPoint& point) {
  const std::vector<int> samples = light_samples(index, point);
  const bool soft = std::any_of(samples.begin(), samples.end(), [](int n) { return n > 1; });
  const std::string pattern = soft ? fmt::format("{} {}", samples_of(point), point.look.seed) : "hard";
  return data_->rays.get(fmt::format("{} {}x{} {}", index, point.width, point.height, pattern), [&] {
    data_->step();
    const RayFrame f(frame(index), point);
    // Every so many pixels and lines, and of these every so many for lights.
    const double pixels = static_cast<double>(point.width) * point.height;
    int step = 1;
    while (pixels * static_cast<double>(f.opaque.triangles.size()) / (step * step) > kMostTests / 2) ++step;
    int lights = 1;
    while (pixels * f.light_tests() / (step * step) / (lights * lights) > kMostTests / 2) ++lights;
    std::vector<RayPixel> out;
    for (int y = step / 2; y < point.height; y += step)
      for (int x = step / 2; x < point.width; x += step) out.push_back({.x = x, .y = y, .layers = {}});
    Arena arena(data_->draw.threads);
    arena.for_each(tbb::blocked_range<std::size_t>(0, out.size(), 256), [&](const auto& range) {
      data_->step();
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const bool ask = out[i].x / step % lights == 0 && out[i].y / step % lights == 0;
        out[i] = ray_pixel(f, out[i].x, out[i].y, ask);
      }
    });
    return out;
  });
}

SweepPoint SweepScene::alone_in_one_pattern(const SweepPoint& point, ErrorSource source) const {
  const SweepPoint p = alone(point, source);
  return source == ErrorSource::samples ? p : one_pattern(p);
}

ErrorMap SweepScene::map_of(int index, const SweepPoint& point, ErrorSource source) {
  const SweepPoint p = alone_in_one_pattern(point, source);
  const SweepPoint best = one_pattern(source == ErrorSource::law ? finest(point) : finest_of_law(point));
  const auto expected = kept_picture(index, best);
  if (text_of(p) == text_of(best))
    return {.width = p.width, .height = p.height, .pixels = std::vector<PixelError>(expected->face.size())};
  data_->step();
  const DrawnFrame drawn = draw(frame(index), p.config, draw_options(p));
  return against_picture(*expected, light_samples(index, best), drawn, light_samples(index, p));
}

std::shared_ptr<const PictureError> SweepScene::error_of(int index, const SweepPoint& point, ErrorSource source) {
  const std::string_view against = source == ErrorSource::law ? "law" : "of law";
  return data_->errors.get(fmt::format("{} {} {}", index, against, text_of(alone_in_one_pattern(point, source))),
                           [&] { return sum_of(map_of(index, point, source)); });
}

void SweepScene::forget(int index) {
  const std::string begin = fmt::format("{} ", index);
  data_->frames.forget(begin);
  data_->truths.forget(begin);
  data_->pictures.forget(begin);
  data_->rays.forget(begin);
  data_->light.forget(begin);
  data_->errors.forget(begin);
}

}  // namespace kage::explore
