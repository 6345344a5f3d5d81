// SPDX-License-Identifier: Apache-2.0
#include "trade/sweep_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image/flip_metric.hpp"
#include "kage/light.hpp"
#include "opinion/oracle.hpp"
#include "opinion/penumbra_truth.hpp"

namespace kage::trade {
namespace {

bool any(const std::array<std::uint8_t, 8>& counts) {
  return std::any_of(counts.begin(), counts.end(), [](std::uint8_t n) { return n > 0; });
}

/// Whether the stated errors of depth excuse what a pixel shows. With several samples it is asked whether any shadow is
/// possible, or none at all.
class Excuses {
 public:
  Excuses(const FrameGeometry& g, const Config& config) : g_(&g), oracle_(g, config) {
    for (std::uint32_t i = 0; i < g.drawn; ++i) by_face_.emplace_back(g.polygons[i].source, i);
    std::sort(by_face_.begin(), by_face_.end());
  }

  void line(int y) { oracle_.line(y); }

  [[nodiscard]] bool face(int x, std::uint32_t shown) const {
    if (shown == kNothing) return oracle_.possible_surface(x, -1, Errors::depth);
    return any_polygon(shown, [&](std::uint32_t p) {
      return oracle_.possible_surface(x, static_cast<std::int32_t>(p), Errors::depth);
    });
  }

  [[nodiscard]] bool shadow(int x, std::uint32_t shown, bool shadowed) const {
    return any_polygon(shown, [&](std::uint32_t p) {
      if (!oracle_.covers(p, x)) return false;
      if (!g_->polygons[p].lit) return !shadowed;
      const PossibleShadow possible = oracle_.possible_shadow(x, p, Errors::depth);
      return shadowed ? possible.shadowed : possible.lit;
    });
  }

 private:
  template <class Test>
  [[nodiscard]] bool any_polygon(std::uint32_t face, Test test) const {
    const auto from = std::lower_bound(by_face_.begin(), by_face_.end(), std::pair{face, 0U});
    for (auto it = from; it != by_face_.end() && it->first == face; ++it)
      if (test(it->second)) return true;
    return false;
  }

  const FrameGeometry* g_;
  Oracle oracle_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_face_;
};

/// Marks pixels that are wrong by the oracle of the point's own snap, and have no excuse.
void mark_gross(const FrameGeometry& g, const Config& config, const ScreenTruth& own, const DrawnFrame& drawn,
                ErrorMap& map) {
  Excuses excuses(g, config);
  int at_line = -1;
  for (std::size_t i = 0; i < own.pixels.size(); ++i) {
    const TruePixel& t = own.pixels[i];
    const bool right_face = drawn.face[i] == t.face;
    if (right_face && (t.face == kNothing || any(drawn.counts[i]) == any(t.counts))) continue;
    const int y = static_cast<int>(i / static_cast<std::size_t>(own.width));
    const int x = static_cast<int>(i % static_cast<std::size_t>(own.width));
    if (y != at_line) excuses.line(at_line = y);
    const bool excused = right_face ? excuses.shadow(x, t.face, any(drawn.counts[i])) : excuses.face(x, drawn.face[i]);
    map.pixels[i].gross = !excused;
  }
}

void ask_rays(SweepScene& scene, int frame, const SweepPoint& point, const DrawnFrame& drawn, const ScreenTruth& truth,
              PointAccuracy& out) {
  if (point.look.cull) return;
  const auto& lights = scene.frame(frame).lights;
  const bool hard = lights.size() == 1 && lights[0].shape == LightShape::point;
  const auto rays = scene.rays(frame, point);
  for (const RayPixel& ray : *rays) {
    const std::size_t i =
        static_cast<std::size_t>(ray.y) * static_cast<std::size_t>(drawn.width) + static_cast<std::size_t>(ray.x);
    ++out.ray_pixels;
    if (drawn.face[i] != ray.face) {
      ++out.ray_visible_wrong;
      continue;
    }
    if (!hard || ray.face == kNothing || truth.pixels[i].face != ray.face || !truth.pixels[i].lit) continue;
    ++out.ray_shadow_pixels;
    if ((drawn.counts[i][0] > 0) != ray.shadowed) ++out.ray_shadow_wrong;
  }
}

}  // namespace

Image image_of(const DrawnFrame& f) {
  Image image(f.width, f.height, 3);
  for (std::size_t i = 0; i < f.color.size(); ++i)
    std::copy(f.color[i].begin(), f.color[i].end(), image.data.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return image;
}

PointAccuracy& PointAccuracy::operator+=(const PointAccuracy& o) {
  by_truth += o.by_truth;
  z_error_max_lsb = std::max(z_error_max_lsb, o.z_error_max_lsb);
  ray_pixels += o.ray_pixels;
  ray_visible_wrong += o.ray_visible_wrong;
  ray_shadow_pixels += o.ray_shadow_pixels;
  ray_shadow_wrong += o.ray_shadow_wrong;
  all += o.all;
  flip += o.flip;
  return *this;
}

ErrorMap error_map(SweepScene& scene, int frame, const SweepPoint& point, const DrawnFrame& drawn) {
  const auto truth = scene.truth(frame, point, kMostSubBits);
  const auto own = scene.truth(frame, point, point.look.sub_bits);
  ErrorMap map = against_truth(*truth, *scene.finest_picture(frame, point), drawn, scene.light_samples(frame, point));
  const FrameGeometry g =
      make_geometry(scene.frame(frame), point.config, point.width, point.height, {.look = point.look});
  mark_gross(g, point.config, *own, drawn, map);
  return map;
}

PointAccuracy accuracy_of(SweepScene& scene, int frame, const SweepPoint& point, const DrawnFrame& drawn, bool flip) {
  PointAccuracy out;
  const auto truth = scene.truth(frame, point, kMostSubBits);
  const auto own = scene.truth(frame, point, point.look.sub_bits);
  const auto finest = scene.finest_picture(frame, point);
  out.by_truth = sum_of(error_map(scene, frame, point, drawn));
  out.z_error_max_lsb = depth_error(*own, drawn, point.config) * depth_steps(point.config);
  ask_rays(scene, frame, point, drawn, *truth, out);
  out.all = sum_of(against_picture(*finest, scene.light_samples(frame, scene.finest(point)), drawn,
                                   scene.light_samples(frame, point)));
  if (flip) out.flip = flip_metric(image_of(*finest), image_of(drawn)).mean;
  return out;
}

std::optional<SoftShare> soft_share(const SceneFrame& frame, const SweepPoint& point) {
  std::optional<SoftShare> out;
  for (std::size_t l = 0; l < frame.lights.size(); ++l) {
    const Light& light = frame.lights[l];
    if (light.shape == LightShape::point) continue;
    const auto points = light_points(light, samples_of(point), point.look.seed + l);
    const verif::EdgeErrors e = verif::edge_errors(light.shape, verif::unit_points(light, points));
    if (!out) out.emplace();
    out->rms = std::max(out->rms, e.rms());
    out->worst = std::max(out->worst, e.worst);
  }
  return out;
}

std::optional<double> psnr(double squares, std::uint64_t pixels) {
  if (squares == 0 || pixels == 0) return std::nullopt;
  return 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(pixels) / squares);
}

}  // namespace kage::trade
