// SPDX-License-Identifier: Apache-2.0
#include "explore/sweep_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image/flip_metric.hpp"
#include "kage/light.hpp"
#include "oracle/oracle.hpp"
#include "oracle/penumbra_truth.hpp"

namespace kage::explore {
namespace {

/// Whether the stated errors of depth excuse what a pixel shows.
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

  [[nodiscard]] bool shadow(int x, std::uint32_t shown, const std::array<std::uint8_t, 8>& counts) const {
    return any_polygon(shown, [&](std::uint32_t p) {
      if (!oracle_.covers(p, x)) return false;
      if (!g_->polygons[p].lit) return counts == std::array<std::uint8_t, 8>{};
      const auto possible = oracle_.possible_counts(x, p, Errors::depth);
      for (std::size_t l = 0; l < counts.size(); ++l)
        if (counts[l] < possible[l].least || counts[l] > possible[l].most) return false;
      return true;
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
    if (right_face && (t.face == kNothing || drawn.counts[i] == t.counts)) continue;
    const int y = static_cast<int>(i / static_cast<std::size_t>(own.width));
    const int x = static_cast<int>(i % static_cast<std::size_t>(own.width));
    if (y != at_line) excuses.line(at_line = y);
    const bool excused = right_face ? excuses.shadow(x, t.face, drawn.counts[i]) : excuses.face(x, drawn.face[i]);
    map.pixels[i].gross = !excused;
  }
}

/// The faces of one list that the other has too, in their order.
std::vector<std::uint32_t> common(const std::vector<std::uint32_t>& of, const std::vector<std::uint32_t>& with) {
  std::vector<std::uint32_t> out;
  for (const std::uint32_t face : of)
    if (std::find(with.begin(), with.end(), face) != with.end()) out.push_back(face);
  return out;
}

/// Shadows of a pixel that shows the right face, and is lit.
void ask_shadows(const RayPixel& ray, const std::array<std::uint8_t, 8>& drawn, const std::vector<int>& samples,
                 PointAccuracy& out) {
  bool asked = false;
  double most = 0;
  for (std::size_t l = 0; l < drawn.size(); ++l) {
    if (ray.counts[l] < 0) continue;
    asked = true;
    most = std::max(most, std::abs(int{drawn[l]} - ray.counts[l]) / static_cast<double>(samples[l]));
  }
  if (!asked) return;
  ++out.ray_shadow_pixels;
  if (most > 0) ++out.ray_shadow_wrong;
  out.ray_shadow_share += most;
}

void ask_rays(SweepScene& scene, int frame, const SweepPoint& point, const DrawnFrame& drawn, const ScreenTruth& truth,
              PointAccuracy& out) {
  if (point.look.cull) return;
  const auto rays = scene.rays(frame, point);
  const std::vector<int> samples = scene.light_samples(frame, point);
  const bool layered = std::any_of(rays->begin(), rays->end(), [](const RayPixel& r) { return r.layers.size() > 1; });
  const auto layers = layered ? draw_layers(scene.frame(frame), point.config, scene.draw_options(point))
                              : std::vector<std::vector<std::uint32_t>>();
  for (const RayPixel& ray : *rays) {
    const std::size_t i =
        static_cast<std::size_t>(ray.y) * static_cast<std::size_t>(drawn.width) + static_cast<std::size_t>(ray.x);
    ++out.ray_pixels;
    if (ray.layers.size() > 1) {
      const auto shown = common(layers[i], ray.layers);
      if (shown.size() > 1) ++out.ray_layer_pixels;
      if (shown != common(ray.layers, layers[i])) ++out.ray_layers_wrong;
    }
    if (drawn.face[i] != ray.face) {
      ++out.ray_visible_wrong;
      continue;
    }
    if (ray.face == kNothing || truth.pixels[i].face != ray.face || !truth.pixels[i].lit) continue;
    ask_shadows(ray, drawn.counts[i], samples, out);
  }
}

}  // namespace

LightErrors light_errors(const LightTruth& truth, const DrawnFrame& drawn) {
  LightErrors e;
  for (const LightPixel& p : truth.pixels) {
    const std::size_t i =
        static_cast<std::size_t>(p.y) * static_cast<std::size_t>(drawn.width) + static_cast<std::size_t>(p.x);
    if (drawn.face[i] != p.face) continue;
    ++e.pixels;
    e.shadowed += p.shadowed ? 1 : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double off = std::abs(drawn.color[i][c] - p.color[static_cast<int>(c)]);
      (p.shadowed ? e.shadow_sum : e.lit_sum) += off;
      double& worst = p.shadowed ? e.shadow_worst : e.lit_worst;
      worst = std::max(worst, off);
      e.squares += off * off;
    }
  }
  return e;
}

ErrorMap light_map(const LightTruth& truth, const DrawnFrame& drawn) {
  ErrorMap map{.width = drawn.width, .height = drawn.height, .pixels = std::vector<PixelError>(drawn.face.size())};
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(drawn.width) + static_cast<std::size_t>(x);
  };
  for (const LightPixel& p : truth.pixels) {
    const std::size_t i = at(p.x, p.y);
    if (drawn.face[i] != p.face) continue;
    PixelError e;
    for (std::size_t c = 0; c < 3; ++c) {
      const double off = std::abs(drawn.color[i][c] - p.color[static_cast<int>(c)]);
      e.color = std::max(e.color, static_cast<std::uint8_t>(std::lround(off)));
    }
    const int left = p.x / truth.step * truth.step;
    const int top = p.y / truth.step * truth.step;
    for (int y = top; y < std::min(top + truth.step, drawn.height); ++y)
      for (int x = left; x < std::min(left + truth.step, drawn.width); ++x) map.pixels[at(x, y)] = e;
  }
  return map;
}

LightErrors& LightErrors::operator+=(const LightErrors& o) {
  pixels += o.pixels;
  shadowed += o.shadowed;
  shadow_sum += o.shadow_sum;
  shadow_worst = std::max(shadow_worst, o.shadow_worst);
  lit_sum += o.lit_sum;
  lit_worst = std::max(lit_worst, o.lit_worst);
  squares += o.squares;
  return *this;
}

double LightErrors::rms() const { return pixels > 0 ? std::sqrt(squares / (3 * static_cast<double>(pixels))) : 0; }

Image image_of(const DrawnFrame& drawn) {
  Image image(drawn.width, drawn.height, 3);
  for (std::size_t i = 0; i < drawn.color.size(); ++i)
    std::copy(drawn.color[i].begin(), drawn.color[i].end(), image.data.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return image;
}

PointAccuracy& PointAccuracy::operator+=(const PointAccuracy& o) {
  by_truth += o.by_truth;
  z_error_max_lsb = std::max(z_error_max_lsb, o.z_error_max_lsb);
  ray_pixels += o.ray_pixels;
  ray_visible_wrong += o.ray_visible_wrong;
  ray_shadow_pixels += o.ray_shadow_pixels;
  ray_shadow_wrong += o.ray_shadow_wrong;
  ray_shadow_share += o.ray_shadow_share;
  ray_layer_pixels += o.ray_layer_pixels;
  ray_layers_wrong += o.ray_layers_wrong;
  all += o.all;
  light += o.light;
  finest_light += o.finest_light;
  steps += o.steps;
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
  if (!point.look.cull) {
    const auto light = scene.light(frame, point);
    out.light = light_errors(*light, drawn);
    out.finest_light = light_errors(*light, *finest);
  }
  out.steps = steps_of(*finest, drawn);
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

}  // namespace kage::explore
