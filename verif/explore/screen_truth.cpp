// SPDX-License-Identifier: Apache-2.0
#include "explore/screen_truth.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "arena/arena.hpp"
#include "oracle/oracle.hpp"

namespace kage::explore {
namespace {

TruePixel pixel(const Oracle& oracle, const FrameGeometry& g, const Config& config, int x) {
  TruePixel out;
  const OraclePixel truth = oracle.at(x);
  if (truth.surface < 0) return out;
  const auto surface = static_cast<std::uint32_t>(truth.surface);
  const ScreenPolygon& polygon = g.polygons[surface];
  out.face = polygon.source;
  out.depth = (oracle.exact_depth(x, surface) - 1) / (std::ldexp(1.0, config.z_bits) - 3);
  out.lit = polygon.lit;
  if (!out.lit || !truth.shadowed) return out;
  std::uint32_t last = ~0U;
  oracle.shadows(x, surface, [&](std::uint32_t sample) {
    if (sample == last) return;  // volumes come in the order of their samples
    last = sample;
    // Counts are of the first lights alone, as those of what is drawn are.
    if (const std::size_t light = g.sample_light[sample]; light < out.counts.size()) ++out.counts[light];
  });
  return out;
}

}  // namespace

ScreenTruth screen_truth(const FrameGeometry& geometry, const Config& config, int threads,
                         const std::function<void()>& step) {
  ScreenTruth out;
  out.width = geometry.width;
  out.height = geometry.height;
  out.pixels.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
  Arena arena(threads);
  arena.for_each(tbb::blocked_range<int>(0, out.height, 4), [&](const tbb::blocked_range<int>& lines) {
    Oracle oracle(geometry, config);
    for (int y = lines.begin(); y < lines.end(); ++y) {
      if (step) step();
      oracle.line(y);
      for (int x = 0; x < out.width; ++x)
        out.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(out.width) + static_cast<std::size_t>(x)] =
            pixel(oracle, geometry, config, x);
    }
  });
  return out;
}

}  // namespace kage::explore
