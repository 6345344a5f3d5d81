// SPDX-License-Identifier: Apache-2.0
#include "direct/draw.hpp"

#include <fmt/format.h>

#include <deque>

#include "direct/band_pixels.hpp"
#include "frontend/band.hpp"
#include "frontend/frame_plan.hpp"
#include "kage/error.hpp"

namespace kage {

bool draw_frame(const FrameGeometry& g, const Config& config, int threads, const std::function<void()>& start,
                const LineSink& sink) {
  FramePlan frame = plan_frame(g, config, true);
  if (g.width > config.max_width)
    throw Error(fmt::format("lines of {} pixels are longer than MAX_WIDTH {}", g.width, config.max_width));
  start();
  Bands bands(g.height, threads);
  std::deque<Band<BandPixels>> made;
  for (std::size_t i = 0; i < bands.wave(); ++i) made.emplace_back(frame, nullptr, frame);
  bool drawn = false;
  bands.make(frame, made, [&](const Band<BandPixels>& band) {
    const BandPixels& pixels = band.target();
    drawn |= pixels.drawn();
    for (int y = pixels.first_line(); y < pixels.end_line(); ++y) sink(y, pixels.line(y - pixels.first_line()));
  });
  return drawn;
}

}  // namespace kage
