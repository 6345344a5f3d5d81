// SPDX-License-Identifier: Apache-2.0
//
// What must hold of any frame with shadow volumes.
#pragma once

#include "catch.hpp"
#include "scene/judge.hpp"

namespace kage::verif {

/// The golden core's picture is the oracle's.
inline void judge_all(const SceneFrame& f, const Config& config, int width, int height, const Look& look = {}) {
  const Judgement j = judge(make_geometry(f, config, width, height, look), config);
  INFO(j.text());
  CHECK(j.good());
}

/// With near and far caps the toggles of every volume sum to zero at every pixel: volumes are closed.
inline void sums_are_zero(const SceneFrame& f, const Config& config, int width, int height) {
  Look look;
  look.far_ends = true;
  const FrameGeometry g = make_geometry(f, config, width, height, look);
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

}  // namespace kage::verif
