// SPDX-License-Identifier: Apache-2.0
//
// The spans of a polygon: what its outline covers, with depth and colour of its planes.
#pragma once

#include <cstdint>

#include "contract/derived.hpp"
#include "frontend/scan.hpp"
#include "frontend/span_setup.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"

namespace kage {

/// The plane of a polygon's colour in one channel, with SMOOTH.
inline ScreenPlane color_plane(const FrameGeometry& g, const ScreenPolygon& p, std::size_t channel) {
  if (p.color_planes >= 0) return g.color_planes[static_cast<std::size_t>(p.color_planes) + channel];
  return {0, 0, std::int64_t{p.color[channel]} << kPlaneFrac, 0, 0};
}

/// Makes spans of polygons; keeps its buffers.
class PolygonSpans {
 public:
  PolygonSpans(const FrameGeometry& geometry, const Config& config)
      : g_(&geometry),
        config_(&config),
        depth_(SpanSetup::depth(config)),
        color_(config.color_frac, derived::smooth_bits(config)) {}

  /// Call emit(y, span, winding) for every span of the polygon on the lines [y0, y1), with range and depth; what a
  /// drawn polygon and a cap emit is the same.
  template <class Emit>
  void each(const ScreenPolygon& p, int y0, int y1, Emit emit) {
    scanner_.scan(g_->outline(p), y0, y1, g_->width, [&](int y, int xl, int xr, int winding) {
      depth_.each(p.depth, xl, xr, y, [&](int from, int to, SpanSetup::Ramp z) {
        SpanToken s;
        s.xl = from;
        s.xr = to;
        s.z = z.start;
        s.dz = z.step;
        emit(y, s, winding);
      });
    });
  }

  /// The colour of a span of the polygon on line y.
  void paint(const ScreenPolygon& p, int y, SpanToken& s) const {
    const auto channels = static_cast<std::size_t>(config_->channels);
    for (std::size_t c = 0; c < channels; ++c) {
      if (config_->smooth == 0) {
        s.color[c] = p.color[c];
        continue;
      }
      const SpanSetup::Ramp r = color_.at(color_plane(*g_, p, c), s.xl, y, s.xr - s.xl);
      s.color[c] = static_cast<std::int32_t>(r.start);
      s.dcolor[c] = static_cast<std::int32_t>(r.step);
    }
  }

 private:
  const FrameGeometry* g_;
  const Config* config_;
  SpanSetup depth_;
  SpanSetup color_;
  Scanner scanner_;
};

}  // namespace kage
