// SPDX-License-Identifier: Apache-2.0
//
// The steps from one share for all shadows to light that is right, and what a picture by one of them is off and takes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "contract/derived.hpp"
#include "cosim/phases.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"
#include "kage/pipeline.hpp"
#include "kage/token.hpp"
#include "oracle/judge.hpp"
#include "oracle/light_reference.hpp"
#include "stimulus/scenes/lit_scenes.hpp"

namespace kage::verif {

/// A way to have light.
struct LightStep {
  std::string_view name;
  int class_bits;
  std::optional<double> darkening;  ///< what all shadows take; none: fitted
  int linear_bits = 0;
};
// All shadows took so much of a colour until shares were fitted.
inline constexpr std::array<LightStep, 7> kLightSteps{{{"constant SHADE", 1, 0.55},
                                                       {"fitted SHADE", 1, std::nullopt},
                                                       {"CLASS_BITS 4", 4, std::nullopt},
                                                       {"CLASS_BITS 8", 8, std::nullopt},
                                                       {"CLASS_BITS 11", 11, std::nullopt},
                                                       {"LINEAR_BITS 10", 1, std::nullopt, 10},
                                                       {"LINEAR_BITS 12", 1, std::nullopt, 12}}};

/// A core of a step for a frame's lights, all else as it is in `c`: smooth colour, and a counter if the step needs one.
/// None: without a table and light after light it has one light.
inline std::optional<Config> config_of(const LightStep& s, const SceneFrame& f, Config c = {}) {
  c.smooth = 1;
  c.color_frac = 8;
  c.class_bits = s.class_bits;
  c.linear_bits = s.linear_bits;
  c.lights = c.linear_bits > 0 ? 1 : static_cast<int>(f.lights.size());
  c.count_bits = f.lights[0].shape != LightShape::point ? 4 : derived::has_table(c) ? 1 : 0;
  if (f.lights.size() > 1 && !derived::has_table(c) && c.linear_bits == 0) return std::nullopt;
  return c;
}

/// A scene's first frame, of which only what is opaque is seen: the reference has no layers.
struct JudgedFrame {
  JudgedFrame(const Scene& scene, int w, int h) : drawn(scene.frame(0, scene.frame_count())), width(w), height(h) {
    SceneFrame opaque = drawn;
    for (Polygon& p : opaque.polygons)
      if (opaque.triangles[p.triangle].alpha < 255) p.count = 0;
    const RayScene rays(opaque);
    reference = reference_picture(LightReference(opaque, rays, sampled_points(opaque, {}), w, h), w, h);
    for (Triangle& t : drawn.triangles)
      if (t.alpha < 255) t.alpha = 0;
  }

  SceneFrame drawn;
  int width;
  int height;
  std::vector<ReferencePixel> reference;
};

/// A picture by a configuration, and what it takes.
struct TakenFrame {
  std::vector<std::uint32_t> picture;  ///< RGB, red in the lowest byte
  LightError error;
  std::uint64_t words = 0;
  std::uint64_t clocks = 0;  ///< by design
};
inline TakenFrame taken(const JudgedFrame& of, const Config& c, const Look& look) {
  const FrameGeometry g = make_geometry(of.drawn, c, of.width, of.height, {.look = look});
  std::vector<std::uint32_t> words;
  make_frame(g, c, 0, words);
  const Layout layout(c);
  PhaseCounter counter(c);
  counter.start(of.width);
  TokenWalk walk(layout, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next()) counter.token(decode(c, layout, token));
  TakenFrame t{draw(g, c), {}, words.size(), counter.sums().clocks()};
  t.error = compare_light(t.picture, of.reference);
  return t;
}

}  // namespace kage::verif
