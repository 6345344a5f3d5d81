// SPDX-License-Identifier: Apache-2.0
// Error of light that the classes of a table of several lights make, by the number of normals that the table tells
// apart. It is taken against a class for each pixel, which has the same law of shares. And the cost of a light's
// samples. 320x240, the scene's own frames; errors in LSB of a channel, over pixels in some shadow.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "bench/timer.hpp"
#include "geometry/shade.hpp"
#include "geometry/view.hpp"
#include "kage/light.hpp"
#include "oracle/light_truth.hpp"
#include "oracle/ray_truth.hpp"
#include "shadow/shadow_caster.hpp"

namespace {

using namespace kage;
using namespace kage::verif;

constexpr int kWidth = 320;
constexpr int kHeight = 240;

struct Errors {
  double sum = 0;
  double worst = 0;
  double share_of_bound = 0;  // directional lights only
  std::uint64_t count = 0;
};

/// Point and normal, turned to the eye, of a triangle where the ray through a pixel's centre meets its plane.
struct Hit {
  glm::dvec3 point;
  glm::dvec3 normal;
  glm::dvec3 of_face;  ///< the mean of its corners' normals, by which it has its class
};

Hit hit(const SceneFrame& f, const Polygon& face, int x, int y) {
  const auto [origin, direction] = pixel_ray(f.camera, x, y, kWidth, kHeight);
  const Triangle& t = f.triangles[face.triangle];
  const glm::dvec3 a = f.vertices[t.vertex[0]];
  const glm::dvec3 u = f.vertices[t.vertex[1]] - a;
  const glm::dvec3 v = f.vertices[t.vertex[2]] - a;
  const glm::dvec3 n = glm::cross(u, v);
  const glm::dvec3 point = origin + direction * (glm::dot(n, a - origin) / glm::dot(n, direction));
  const glm::dvec3 p = point - a;
  const double nn = glm::dot(n, n);
  const double s = glm::dot(glm::cross(p, v), n) / nn;
  const double r = glm::dot(glm::cross(u, p), n) / nn;
  glm::dvec3 normal = f.shading[t.shading[0]].normal;
  glm::dvec3 mean = normal;
  if (f.outline(face).size() == 3) {
    mean = f.shading[t.shading[0]].normal + f.shading[t.shading[1]].normal + f.shading[t.shading[2]].normal;
    normal = f.shading[t.shading[0]].normal * (1 - s - r) + f.shading[t.shading[1]].normal * s +
             f.shading[t.shading[2]].normal * r;
  }
  const double side = glm::dot(n, direction) > 0 ? -1 : 1;
  return {point, side * glm::normalize(normal), side * glm::normalize(mean)};
}

/// Adds to `e` the error of the picture of frame `f` against one that keeps each light's intensity for every pixel.
void measure(const SceneFrame& f, const Config& config, const Look& look, Errors& e) {
  const FrameGeometry g = make_geometry(f, config, kWidth, kHeight, {.look = look});
  const auto picture = draw(g, config);
  const auto unshadowed = draw(only_sample(g, ~0U), for_one_sample(config));
  const auto seen = seen_polygons(g, config);
  const auto counts = shadow_counts(g, config);
  std::vector<double> samples(f.lights.size(), 0);
  for (const auto l : g.sample_light) ++samples[l];
  const Lighting lighting(f.lights, f.camera.up);
  const NormalClasses classes(look.classes);
  const View view(f.camera, kWidth, kHeight, config.z_bits, {f.camera.near, 1e3});
  std::vector<ShadowCaster> casters;
  for (const Light& l : f.lights) casters.emplace_back(f, l, view.near_corners(), 1);
  const bool directional = std::all_of(f.lights.begin(), f.lights.end(), [](const Light& l) { return l.directional; });
  for (std::size_t i = 0; i < picture.size(); ++i) {
    if (seen[i] == ~0U || g.polygons[seen[i]].normal_class == 0) continue;
    if (std::all_of(counts[i].begin(), counts[i].end(), [](auto n) { return n == 0; })) continue;
    const Polygon& face = f.polygons[g.polygons[seen[i]].source];
    const Hit at = hit(f, face, static_cast<int>(i % kWidth), static_cast<int>(i / kWidth));
    std::bitset<kMaxLights> lit;
    const Triangle& t = f.triangles[face.triangle];
    const glm::dvec3 a = f.vertices[t.vertex[0]];
    const glm::dvec3 n = glm::cross(f.vertices[t.vertex[1]] - a, f.vertices[t.vertex[2]] - a);
    const glm::dvec3 to_eye = f.camera.perspective ? f.camera.eye - a : -f.camera.forward;
    for (std::size_t l = 0; l < f.lights.size(); ++l) lit[l] = casters[l].facing(face) * glm::dot(n, to_eye) > 0;
    const auto shares = lighting.shares(at.point, at.normal, lit, false);
    const glm::dvec3 off_class = at.normal - classes.normal(classes.nearest(at.of_face));
    const double radius = std::sqrt(glm::dot(off_class, off_class));
    for (unsigned c = 0; c < 3; ++c) {
      double keep = 1;
      double weight = 0.04;
      for (std::size_t l = 0; l < f.lights.size(); ++l) {
        keep -= counts[i][l] / samples[l] * shares[l][static_cast<int>(c)];
        weight += 0.8 * f.lights[l].color[static_cast<int>(c)];
      }
      const double color = unshadowed[i] >> (8 * c) & 255U;
      const double off = std::abs((picture[i] >> (8 * c) & 255U) - color * keep);
      e.sum += off;
      ++e.count;
      e.worst = std::max(e.worst, off);
      if (directional)
        e.share_of_bound = std::max(
            e.share_of_bound,
            (off - 0.5) / (color * (2.32 * weight * radius + 0x1p-17 * static_cast<double>(g.sample_light.size()))));
    }
  }
}

SceneFrame with_suns(SceneFrame f) {
  for (Light& l : f.lights) {
    if (l.directional) continue;
    const double n = std::sqrt(glm::dot(l.position, l.position));
    Light sun;
    sun.direction = -l.position / n;
    sun.color = l.color / (n * n);
    l = sun;
  }
  return f;
}

void table_errors(const char* title, const Scene& scene, bool suns, bool flat) {
  fmt::print("{}\n", title);
  for (int classes = 8; classes <= 1024; classes *= 2) {
    Errors e;
    std::size_t used = 0;
    for (int i = 0; i < scene.frame_count(); i += 2) {
      SceneFrame f = scene.frame(i, scene.frame_count());
      if (suns) f = with_suns(f);
      Config c;
      c.smooth = flat ? 0 : 1;
      c.color_frac = flat ? 0 : 8;
      c = config_for_lights(f, 15, c);
      c.class_bits = 11;
      Look look;
      look.classes = classes;
      measure(f, c, look, e);
      used = std::max(used, make_geometry(f, c, kWidth, kHeight, {.look = look}).shares.size() /
                                static_cast<std::size_t>(c.lights));
    }
    fmt::print("  {:5} normals, {:4} classes in use: mean {:6.3f} LSB, at most {:6.2f}{}\n", classes, used,
               e.sum / static_cast<double>(e.count), e.worst,
               suns ? fmt::format(", {:.2f} of the bound", e.share_of_bound) : "");
  }
}

void sample_costs(const Scene& scene) {
  fmt::print("{}: golden core by samples, 640x480, least of 5 runs\n", scene.name());
  const SceneFrame f = scene.frame(0, scene.frame_count());
  for (const int samples : {1, 2, 4, 8, 16, 32, 64, 128, 255}) {
    Config c = config_for_lights(f, 255);
    Look look;
    look.samples = samples;
    bench::Timer timer;
    const FrameGeometry g = make_geometry(f, c, 640, 480, {.look = look});
    const double geometry = timer.seconds();
    std::vector<std::uint32_t> words;
    timer = {};
    make_frame(g, c, 0, words, {.threads = 1});
    const double front_end = timer.seconds();
    const TokenCounts counts = check_frame(c, words, "frame", 0);
    GoldenCore core(c);
    double best = 1e9;
    for (int r = 0; r < 5; ++r) {
      timer = {};
      (void)core.frame(words, [](int, std::span<const std::uint8_t>) {});
      best = std::min(best, timer.seconds());
    }
    const double pixels = 640.0 * 480;
    fmt::print(
        "  {:3} samples: geometry {:7.2f} ms, front end {:7.2f} ms, {:8} spans, {:6.1f} span pixels a pixel, golden "
        "{:7.2f} ns a pixel, {:5.2f} a sample\n",
        samples, geometry * 1e3, front_end * 1e3, counts.spans, static_cast<double>(counts.span_pixels) / pixels,
        best * 1e9 / pixels, best * 1e9 / pixels / samples);
  }
}

}  // namespace

int main() {
  const Scene three = Scene::load("three-lights");
  table_errors("three-lights with three suns, smooth", three, true, false);
  table_errors("three-lights with three suns, flat: a face has one class and one colour", three, true, true);
  table_errors("three-lights as it is, a spot and a disc among them, smooth: no bound", three, false, false);
  sample_costs(Scene::load("penumbra"));
  return 0;
}
