// SPDX-License-Identifier: Apache-2.0
//
// What must hold of any frame with shadow volumes.
#pragma once

#include <span>

#include "opinion/judge.hpp"
#include "stimulus/shapes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {

/// Boxes over a floor, in threes and in this order: a box, one round it, and one that overlaps or touches them, `aside`
/// of them.
inline SceneFrame box_threes(std::span<const int> order, double aside) {
  SceneFrame f;
  add_solid(f, box_solid(), {0, -3, 0}, {8, 0.5, 8}, Turn{}, {1, 1, 1});
  for (const int i : order) {
    const int column = i / 3 % 5;
    const int row = i / 15;
    const glm::dvec3 centre{column * 1.5 - 3, 0, row * 1.5 - 3};
    if (i % 3 == 2)
      add_solid(f, box_solid(), centre + glm::dvec3(aside, 0, 0), {0.2, 0.2, 0.2}, Turn{}, {1, 1, 1});
    else
      add_solid(f, box_solid(), centre, glm::dvec3(i % 3 == 0 ? 0.2 : 0.3), Turn{}, {1, 1, 1});
  }
  f.lights[0].direction = glm::normalize(glm::dvec3(0.3, -1, 0.2));
  look_at(f.camera, {5, 6, 7}, {0, -1, 0});
  return f;
}

/// The golden core's picture is the oracle's.
inline void judge_all(const SceneFrame& f, const Config& config, int width, int height, const Look& look = {}) {
  const Judgement j = judge(make_geometry(f, config, width, height, {.look = look}), config);
  INFO(j.text());
  CHECK(j.good());
}

/// With near and far caps the toggles of every volume sum to zero at every pixel: volumes are closed.
inline void sums_are_zero(const SceneFrame& f, const Config& config, int width, int height, Look look = {}) {
  look.far_ends = true;
  look.leave_out = false;
  const FrameGeometry g = make_geometry(f, config, width, height, {.look = look});
  Oracle oracle(g, config);
  std::uint64_t wrong = 0;
  std::uint64_t touched = 0;
  for (int y = 0; y < height; ++y) {
    oracle.line(y);
    for (std::uint32_t v = 0; v < g.volumes.size(); ++v)
      for (int x = 0; x < width; ++x) {
        wrong += oracle.sum_of_toggles(v, x) != 0 ? 1 : 0;
        ++touched;
      }
  }
  CAPTURE(touched);
  CHECK(wrong == 0);
}

/// Whether the stated errors leave open what is to be seen at a pixel or whether it lies in shadow.
inline bool open_to_errors(const FrameGeometry& g, const Config& config, int x, int y) {
  Oracle oracle(g, config);
  oracle.line(y);
  const std::int32_t surface = oracle.at(x).surface;
  if (surface < 0) return false;
  const PossibleShadow p = oracle.possible_shadow(x, static_cast<std::uint32_t>(surface), Errors::depth_and_snap);
  return p.lit && p.shadowed;
}

/// Where the pictures of two geometries of a frame differ, one of them is a near tie. Returns how many pixels do.
inline std::size_t same_but_near_ties(const FrameGeometry& a, const Config& ca, const FrameGeometry& b,
                                      const Config& cb) {
  const auto p = draw(a, ca);
  const auto q = draw(b, cb);
  REQUIRE(p.size() == q.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i] == q[i]) continue;
    ++different;
    const int x = static_cast<int>(i) % a.width;
    const int y = static_cast<int>(i) / a.width;
    CAPTURE(x, y);
    CHECK((open_to_errors(a, ca, x, y) || open_to_errors(b, cb, x, y)));
  }
  CAPTURE(different);
  CHECK(different * 200 < p.size());
  return different;
}

}  // namespace kage::verif
