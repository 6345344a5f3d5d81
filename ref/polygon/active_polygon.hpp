// SPDX-License-Identifier: Apache-2.0
//
// The front end's state of a polygon, kept from line to line, and the polygon's span on a line. The arithmetic is that
// of the kernels (hls/kernels), from which the RTL's is made.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

#include "contract/derived.hpp"
#include "kage/token.hpp"
#include "kernels/edge_setup.hpp"
#include "kernels/edge_step.hpp"
#include "kernels/plane_step.hpp"
#include "kernels/span_setup.hpp"
#include "number/bits.hpp"
#include "number/first_centre.hpp"
#include "polygon/place.hpp"

namespace kage {

/// A plane at pixel 0 of the line above, in 2^-24; sums wrap. 54 bits are the most that any plane has.
struct WalkedPlane {
  static constexpr int kBits = kGreatest.z_bits + 26;
  using Value = hw::s<kBits>;

  Value value{0};
  Value right{0};
  Value down{0};

  WalkedPlane() = default;
  explicit WalkedPlane(const PolygonToken& t) : value(t.value), right(t.right), down(t.down) {}

  /// The same on the next line.
  void next() { value = value + down; }

  /// Start and step of a span of `count` pixels from xl on: fields of `bits` bits, FRAC of them a fraction.
  struct Ramp {
    std::int64_t start;
    std::int64_t step;
  };
  [[nodiscard]] Ramp at(int xl, int count, int frac, int bits) const {
    hls::PlaneStepIn<kBits> in;
    in.value = value;
    in.right = right;
    in.down = down;
    in.move = hw::s<17>(xl);
    hls::PlaneStepOut<kBits> here;
    hls::plane_step(in, here);
    const hls::SpanRounding rounding = hls::span_rounding(frac);
    hls::SpanSetupIn<kBits> setup;
    setup.value = here.value;
    setup.slope = right;
    setup.single = hw::u<1>(count == 1);
    setup.start_rounding = Value(rounding.start);
    setup.step_rounding = Value(rounding.step);
    hls::SpanSetupOut<kBits> out;
    hls::span_setup(setup, out);
    const auto cut = [&](const Value& v) {
      return sign_extend(static_cast<std::uint64_t>(hw::value(v)) >> (kPlaneFrac - frac), bits);
    };
    return {cut(out.start), cut(out.step)};
  }
};

// The widths that rtl/defs/kage.yaml gives an edge are the kernels'.
static_assert(std::is_same_v<decltype(hls::Edge::x), hw::s<kCrossingBits>>);
static_assert(std::is_same_v<decltype(hls::Edge::step), hw::s<kCrossingBits>>);
static_assert(std::is_same_v<decltype(hls::Edge::rest), hw::u<kEdgeRestBits>>);
static_assert(std::is_same_v<decltype(hls::Edge::rest_step), hw::u<kEdgeRestBits>>);
static_assert(std::is_same_v<decltype(hls::Edge::dy), hw::u<kEdgeRestBits>>);

/// A polygon between its first line and its last.
struct ActivePolygon {
  Place place;
  std::array<hls::Edge, 2> edges;
  int end = kNoEnd;  ///< one past its last line
  WalkedPlane depth;
  std::array<WalkedPlane, 3> color;  ///< with SMOOTH
  SpanToken look;                    ///< class, weight, alpha; without SMOOTH the colour

  static constexpr int kNoEnd = (1 << (kEndLineBits - 1)) - 1;

  /// Begins with a POLYGON.
  ActivePolygon() = default;
  ActivePolygon(const Config& config, Place at, const Token& t) : place(at), depth(t.polygon) {
    look.normal_class = t.span.normal_class;
    look.w = t.span.w;
    look.alpha = t.span.alpha;
    look.color = t.span.color;
    if (config.smooth == 0) return;
    for (std::size_t c = 0; c < 3; ++c)
      color[c].value = WalkedPlane::Value(std::int64_t{t.span.color[c]} << kPlaneFrac);
  }

  /// An edge begins: on this line, of the EDGE.
  void set_edge(const PolygonToken& t, const hls::Edge& edge) {
    edges[static_cast<std::size_t>(t.side)] = edge;
    if (t.last) end = first_centre(t.bottom_y);
  }

  /// The edge of an EDGE where it crosses line y.
  static hls::Edge edge_at(const PolygonToken& t, int y) {
    hls::EdgeSetupIn in;
    in.top_x = hls::Subpixel(t.top_x);
    in.top_y = hls::Subpixel(t.top_y);
    in.bottom_x = hls::Subpixel(t.bottom_x);
    in.bottom_y = hls::Subpixel(t.bottom_y);
    in.line = hls::Line(y);
    hls::Edge edge;
    hls::edge_setup(in, edge);
    return edge;
  }

  /// Its span on the line at hand, which is empty where its edges cross the same pixel's left side.
  [[nodiscard]] SpanToken span(const Config& config, int width) const {
    const auto x = [&](const hls::Edge& e) { return std::clamp(static_cast<int>(hw::value(e.x)), 0, width); };
    const int down = x(edges[0]);
    const int up = x(edges[1]);
    SpanToken s = look;
    s.xl = std::min(down, up);
    s.xr = std::max(down, up);
    if (s.xl == s.xr) return s;
    // A span whose left edge goes up is outside as much as others are inside.
    if (up < down && config.dsf_bits > 0)
      s.w = static_cast<int>(sign_extend(static_cast<std::uint64_t>(-look.w), config.dsf_bits + 1));
    const int count = s.xr - s.xl;
    const auto z = depth.at(s.xl, count, config.z_frac, derived::depth_bits(config));
    s.z = z.start;
    s.dz = z.step;
    if (config.smooth == 0 || (place.layer() == static_cast<int>(Layer::volumes) && !place.is_light(config))) return s;
    for (std::size_t c = 0; c < static_cast<std::size_t>(config.channels); ++c) {
      const auto ramp = color[c].at(s.xl, count, config.color_frac, derived::smooth_bits(config));
      s.color[c] = static_cast<std::int32_t>(ramp.start);
      s.dcolor[c] = static_cast<std::int32_t>(ramp.step);
    }
    return s;
  }

  /// Go to the next line.
  void next() {
    for (hls::Edge& e : edges) {
      hls::Edge on;
      hls::edge_step(e, on);
      e = on;
    }
    depth.next();
    for (WalkedPlane& p : color) p.next();
  }
};

}  // namespace kage
