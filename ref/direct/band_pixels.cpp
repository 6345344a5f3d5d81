// SPDX-License-Identifier: Apache-2.0
#include "direct/band_pixels.hpp"

#include <algorithm>

#include "contract/derived.hpp"

namespace kage {

BandPixels::BandPixels(const FramePlan& frame)
    : has_shadows_(frame.config->dsf_bits > 0),
      linear_(frame.config->linear_bits > 0),
      line_bytes_(static_cast<std::size_t>(frame.geometry->width) * static_cast<std::size_t>(frame.config->channels)),
      bytes_(line_bytes_ * static_cast<std::size_t>(std::min(kBandLines, frame.geometry->height))),
      pyramid_(*frame.geometry, *frame.config) {
  const FrameGeometry& g = *frame.geometry;
  Config config = *frame.config;
  config.max_width = g.width;
  PixelLine line(config);
  line.start(g.width, g.background);
  if (!derived::has_table(config) && has_shadows_ && g.passes.empty() && !g.volumes.empty()) line.set_shade(g.shade);
  const auto lights = static_cast<std::size_t>(config.lights);
  if (derived::has_table(config))
    for (std::size_t i = 0; i < g.shares.size(); ++i)
      line.add_share({static_cast<int>(i / lights) + 1, static_cast<int>(i % lights), g.shares[i]});
  lines_.assign(static_cast<std::size_t>(std::min(kBandLines, g.height)), line);
}

void BandPixels::start(int y0, int y1) {
  y0_ = y0;
  y1_ = y1;
  drawn_ = false;
  shadows_.fill(false);
}

void BandPixels::end_opaque() {
  if (!has_shadows_) return;
  pyramid_.start(y0_, y1_);
  for (int y = y0_; y < y1_; ++y) pyramid_.add_line(y, at(y).depths().data());
}

void BandPixels::end(const BandWork& /*work*/) {
  for (int y = y0_; y < y1_; ++y) {
    resolve_shadows(y);
    at(y).finish(false, std::span(bytes_).subspan(index(y) * line_bytes_, line_bytes_));
  }
}

}  // namespace kage
