// SPDX-License-Identifier: Apache-2.0
//
// The spans of a polygon: what its outline covers, with depth and colour of its planes.
#pragma once

#include <cstdint>

#include "contract/derived.hpp"
#include "frontend/cut.hpp"
#include "frontend/scan.hpp"
#include "frontend/span_setup.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"

namespace kage {

/// The plane of a polygon's colour in one channel, with SMOOTH.
/// @param pass with linear light: 0 for that from everywhere, or 1 and on for a light's
inline ScreenPlane color_plane(const FrameGeometry& g, const ScreenPolygon& p, std::size_t channel,
                               std::size_t pass = 0) {
  if (p.light_planes >= 0) return g.color_planes[static_cast<std::size_t>(p.light_planes) + 3 * pass + channel];
  if (p.color_planes >= 0) return g.color_planes[static_cast<std::size_t>(p.color_planes) + channel];
  return {0, 0, std::int64_t{p.color[channel]} << kPlaneFrac, 0, 0};
}

/// Whether its colour is not the same everywhere.
inline bool has_color_planes(const ScreenPolygon& p) { return p.color_planes >= 0 || p.light_planes >= 0; }

/// Bits of a channel that a pixel takes of it.
inline int level_bits(const Config& config, const ScreenPolygon& p, std::size_t pass) {
  if (p.light_planes < 0) return 8;
  return pass == 0 ? derived::pixel_level_bits(config) : derived::lane_level_bits(config);
}

/// Makes spans of polygons; keeps its buffers.
class PolygonSpans {
 public:
  PolygonSpans(const FrameGeometry& geometry, const Config& config)
      : g_(&geometry),
        config_(&config),
        depth_(SpanSetup::depth(config)),
        color_(SpanSetup::color(config, 8)),
        ambient_(SpanSetup::color(config, derived::pixel_level_bits(config))),
        light_(SpanSetup::color(config, derived::lane_level_bits(config))) {}

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

  /// Call emit(span) for the parts of a span of the polygon on line y, from left to right, each with its colour and
  /// class: one, or those of the shades of a diced polygon. Depth is that of the whole span, bit for bit. With linear
  /// light `pass` is 0 for that from everywhere, or 1 and on for a light's.
  template <class Emit>
  void painted(const ScreenPolygon& p, int y, SpanToken& s, std::size_t pass, Emit emit) const {
    if (p.shade_cut >= 0 && config_->smooth != 0) return diced(p, y, p.shade_cut, s, pass, emit);
    if (p.light_planes < 0) s.normal_class = span_class(p, *config_);
    paint(p, y, pass, s);
    emit(s);
  }

  /// The colour of a span of a polygon on line y that is not diced.
  void paint(const ScreenPolygon& p, int y, std::size_t pass, SpanToken& s) const {
    for (std::size_t c = 0; c < channels(); ++c) {
      s.color[c] = p.color[c];
      if (config_->smooth != 0) ramp(setup(p, pass), color_plane(*g_, p, c, pass), c, y, s);
    }
  }

  /// Restricts a span to [xl, xr), with its depth there.
  static void restrict(SpanToken& s, int xl, int xr) {
    s.z += std::int64_t{xl - s.xl} * s.dz;
    s.xl = xl;
    s.xr = xr;
  }

 private:
  [[nodiscard]] std::size_t channels() const { return static_cast<std::size_t>(config_->channels); }

  [[nodiscard]] const SpanSetup& setup(const ScreenPolygon& p, std::size_t pass) const {
    return p.light_planes < 0 ? color_ : pass == 0 ? ambient_ : light_;
  }

  [[nodiscard]] const ScreenPlane& plane(std::uint32_t first, std::size_t pass, std::size_t channel) const {
    return g_->color_planes[first + 3 * pass + channel];
  }

  void ramp(const SpanSetup& setup, const ScreenPlane& plane, std::size_t channel, int y, SpanToken& s) const {
    const SpanSetup::Ramp r = setup.at(plane, s.xl, y, s.xr - s.xl);
    s.color[channel] = static_cast<std::int32_t>(r.start);
    s.dcolor[channel] = static_cast<std::int32_t>(r.step);
  }

  // The part of a span on this side of all cuts above `at`.
  template <class Emit>
  void diced(const ScreenPolygon& p, int y, std::int32_t at, const SpanToken& s, std::size_t pass, Emit emit) const {
    if (at < 0) {
      const std::int32_t number = ~at;
      const Shade& shade = g_->shades[static_cast<std::size_t>(number)];
      SpanToken part = s;
      part.normal_class = derived::has_table(*config_) ? static_cast<int>(shade.normal_class) : span_class(p, *config_);
      for (std::size_t c = 0; c < channels(); ++c) ramp(setup(p, pass), plane(shade.color_planes, pass, c), c, y, part);
      return emit(part);
    }
    const ShadeCut& cut = g_->shade_cuts[static_cast<std::size_t>(at)];
    const auto side = [&](std::int32_t next, int from, int end) {
      if (from >= end) return;
      SpanToken part = s;
      restrict(part, from, end);
      diced(p, y, next, part, pass, emit);
    };
    int xl = s.xl;
    int xr = s.xr;
    restrict_to(cut.line, true, y, xl, xr);
    if (xl == s.xl) {
      side(cut.front, xl, xr);
      side(cut.behind, xr, s.xr);
    } else {
      side(cut.behind, s.xl, xl);
      side(cut.front, xl, xr);
    }
  }

  const FrameGeometry* g_;
  const Config* config_;
  SpanSetup depth_;
  SpanSetup color_;    // as displayed
  SpanSetup ambient_;  // linear light from everywhere
  SpanSetup light_;    // a sample's
  Scanner scanner_;
};

}  // namespace kage
