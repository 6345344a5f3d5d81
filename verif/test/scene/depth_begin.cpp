// SPDX-License-Identifier: Apache-2.0
// The built-in scenes with depth from w0, against depth from the camera's near plane: what changes is a near tie.
//
// `scene_depth_begin -s` prints how many pixels change in each scene, and which bodies leave their units because w0
// cuts them.
#include <algorithm>

#include "oracle/ray_truth.hpp"
#include "test/scene/shadow_checks.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

struct Change {
  std::size_t pixels = 0;
  std::size_t surfaces = 0;
  std::size_t shadows = 0;
  std::size_t gross = 0;
  std::size_t bodies = 0;  ///< bodies, a frame each
};

std::uint32_t face_of(const FrameGeometry& g, std::uint32_t seen) {
  return seen == kNothing ? kNothing : g.polygons[seen].source;
}

/// Where the two pictures differ, the errors of one of them allow both answers.
Change compare(const FrameGeometry& now, const FrameGeometry& before, const Config& config) {
  Change c;
  const RayPictures p = ray_pictures(now, config);
  const RayPictures q = ray_pictures(before, config);
  Oracle of_now(now, config);
  Oracle of_before(before, config);
  for (int y = 0; y < kHeight; ++y) {
    of_now.line(y);
    of_before.line(y);
    for (int x = 0; x < kWidth; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
      ++c.pixels;
      const std::uint32_t face = face_of(now, p.seen[at]);
      const std::uint32_t other = face_of(before, q.seen[at]);
      if (face != other) {
        ++c.surfaces;
        if (!possible_face(of_now, now, x, y, other) && !possible_face(of_before, before, x, y, face)) ++c.gross;
      } else if (face != kNothing && p.shadow[at] != q.shadow[at]) {
        ++c.shadows;
        const auto open = [&](const Oracle& oracle, std::uint32_t surface) {
          const PossibleShadow s = oracle.possible_shadow(x, surface, Errors::depth_and_snap);
          return s.lit && s.shadowed;
        };
        if (!open(of_now, p.seen[at]) && !open(of_before, q.seen[at])) ++c.gross;
      }
    }
  }
  return c;
}

}  // namespace

TEST_CASE("built-in scenes: depth from w0 changes no pixel but near ties") {
  Look from_near;
  from_near.depth_from_near = true;
  for (const std::string& name : builtin_scenes()) {
    const Scene scene = Scene::load(name);
    Change sum;
    std::vector<std::string> bodies;
    for (int i = 0; i < scene.frame_count(); ++i) {
      CAPTURE(name, i);
      const SceneFrame f = scene.frame(i, scene.frame_count());
      Config config;
      config.lights = 1;
      const FrameGeometry now = make_geometry(f, config, kWidth, kHeight);
      const FrameGeometry before = make_geometry(f, config, kWidth, kHeight, {.look = from_near});
      const Change c = compare(now, before, config);
      CHECK(c.gross == 0);
      sum.pixels += c.pixels;
      sum.surfaces += c.surfaces;
      sum.shadows += c.shadows;
      for (std::size_t k = 0; k < f.components.size(); ++k) {
        if (now.span_reasons[k] == before.span_reasons[k]) continue;
        CHECK(now.span_reasons[k] == SpanReason::cut);
        bodies.push_back(fmt::format("{} in frame {}", scene.objects()[f.triangles[f.components[k].first].object], i));
      }
    }
    UNSCOPED_INFO(fmt::format("{}: of {} pixels {} show another surface and {} another shadow; bodies that w0 cuts: {}",
                              name, sum.pixels, sum.surfaces, sum.shadows,
                              bodies.empty() ? "none" : fmt::format("{}", fmt::join(bodies, ", "))));
    CHECK((sum.surfaces + sum.shadows) * 1000 < sum.pixels);
  }
}

}  // namespace kage::verif
