// SPDX-License-Identifier: Apache-2.0
//
// Properties of any frame with shadow volumes, as assertions.
#pragma once

#include "extremes/shadow_checks.hpp"
#include "oracle/ray_truth.hpp"
#include "test/extremes/hold.hpp"

namespace kage::verif {

/// The golden core's picture is the oracle's.
inline void judge_all(const SceneFrame& f, const Config& config, int width, int height, const Look& look = {}) {
  holds(picture_is_the_oracles(make_geometry(f, config, width, height, {.look = look}), config));
}

/// With near and far caps the toggles of every volume sum to zero at every pixel: volumes are closed.
inline void sums_are_zero(const SceneFrame& f, const Config& config, int width, int height, const Look& look = {}) {
  holds(volumes_are_closed(f, config, width, height, Context{}, look));
}

/// The rays have decided something: neither all is shadow nor all light, and the snap excused no more than this share.
inline void rays_decided(const RayCount& count, double excused = 0.01) {
  INFO(count.text());
  CHECK(count.shadowed > 1000);
  CHECK(count.lit > 1000);
  CHECK(static_cast<double>(count.near_surface + count.near_shadow) < excused * static_cast<double>(count.pixels));
}

/// Rays agree with each of so many scenes, of which `one(i)` gives the ith's count, and have decided something of all
/// together. Returns what they came to.
template <class One>
RayCount rays_agree(int scenes, One one, double excused = 0.01) {
  RayCount count;
  for (int i = 0; i < scenes; ++i) {
    CAPTURE(i);
    count += one(i);
    INFO(count.text());
    REQUIRE(count.good());
  }
  rays_decided(count, excused);
  return count;
}

/// Where the pictures of two geometries of a frame differ, one of them is a near tie. Returns how many pixels do.
inline std::size_t same_but_near_ties(const FrameGeometry& a, const Config& ca, const FrameGeometry& b,
                                      const Config& cb) {
  const TwoPictures two = same_but_near_ties_count(a, ca, b, cb);
  holds(two.outcome());
  return two.different;
}

}  // namespace kage::verif
