// SPDX-License-Identifier: Apache-2.0
//
// Frames of one white line under samples of lights whose shadows are known: what family 29 is made of.
#pragma once

#include <algorithm>
#include <vector>

#include "kage/stream.hpp"

namespace kage::verif {

/// The pixels in shadow of one sample of a light.
struct LightSample {
  int xl, xr, light;
};

/// A white line of class 1 with these samples, in this order; a sample of light i takes shares[i] of the line.
inline std::vector<std::uint32_t> light_frame(const Config& c, int width, const std::vector<LightSample>& samples,
                                              const std::vector<std::uint32_t>& shares) {
  std::vector<std::uint32_t> words;
  TokenWriter w(c, words);
  w.header({width, 1, 0, 0});
  if (c.class_bits == 1) w.shade(shares[0]);
  for (int light = 0; c.class_bits > 1 && light < c.lights; ++light) {
    const std::uint32_t share = shares[static_cast<std::size_t>(light)];
    w.table({1, light, {share, share, share}});
  }
  SpanToken span;
  span.xr = width;
  span.z = std::int64_t{5} << c.z_frac;
  span.normal_class = 1;
  const std::int32_t white = c.smooth != 0 ? 255 << c.color_frac : 255;
  span.color = {white, white, white};
  w.op(span);
  for (const LightSample& s : samples) {
    w.nc(s.xl, s.xr, 1);
    if (c.fsf != 0) w.ev(s.xl, s.xr);
    w.es(s.xl, s.xr, s.light);
  }
  if (!samples.empty()) w.resolve();
  w.eol(0);
  w.end();
  return words;
}

/// Value of pixel x of that line. Each light's samples over it are counted up to what a counter holds, and their shares
/// are taken from 255, rounded.
inline std::uint8_t light_pixel(const Config& c, int x, const std::vector<LightSample>& samples,
                                const std::vector<std::uint32_t>& shares) {
  std::vector<std::uint64_t> counts(shares.size());
  for (const LightSample& s : samples)
    if (x >= s.xl && x < s.xr) ++counts[static_cast<std::size_t>(s.light)];
  const std::uint64_t one = std::uint64_t{1} << c.shade_frac;
  const std::uint64_t most = (std::uint64_t{1} << c.count_bits) - 1;
  std::uint64_t lost = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) lost += std::min(counts[i], most) * shares[i];
  return static_cast<std::uint8_t>((255 * (one - std::min(lost, one)) + one / 2) / one);
}

}  // namespace kage::verif
