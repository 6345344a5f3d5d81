// SPDX-License-Identifier: Apache-2.0
//
// Frames made of screen polygons by hand, and hit counts.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "frontend/scan.hpp"
#include "kage/geometry.hpp"
#include "stimulus/random.hpp"

namespace kage::verif {

using Outline = std::vector<ScreenVertex>;

/// Where a pixel is among those of a picture, line by line.
constexpr std::size_t pixel_index(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

/// How often each pixel of a width x height screen is hit.
class Hits {
 public:
  Hits(int width, int height)
      : width_(width), height_(height), count_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  /// `wider` pixels are added at the right end of each run of three pixels or more, for tests that must see it.
  void add(const Outline& o, int wider = 0) {
    scanner_.scan(o, 0, height_, width_, [&](int y, int xl, int xr, int) {
      for (int x = xl; x < (xr - xl >= 3 ? std::min(width_, xr + wider) : xr); ++x) ++count_[pixel_index(x, y, width_)];
    });
  }

  [[nodiscard]] int at(int x, int y) const { return count_[pixel_index(x, y, width_)]; }
  [[nodiscard]] const std::vector<int>& all() const { return count_; }
  [[nodiscard]] std::size_t unlike(int expected) const {
    std::size_t n = 0;
    for (const int c : count_) n += c != expected ? 1 : 0;
    return n;
  }

 private:
  int width_;
  int height_;
  std::vector<int> count_;
  Scanner scanner_;
};

/// Twice the signed area of a triangle.
inline std::int64_t area2(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) - (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

/// Triangles that together are the rectangle from (x0, y0) to (x1, y1), in subpixels: points are strewn into triangles,
/// which fall in three. All coordinates are multiples of `step`, a power of two up to 128, if the rectangle's are.
inline std::vector<Outline> triangulate(Random& random, int x0, int y0, int x1, int y1, int points, int step = 1) {
  std::vector<Outline> t{{{x0, y0}, {x0, y1}, {x1, y1}}, {{x0, y0}, {x1, y1}, {x1, y0}}};
  for (int i = 0; i < points; ++i) {
    const auto at = static_cast<std::size_t>(random.in(0, static_cast<int>(t.size()) - 1));
    const Outline o = t[at];
    ScreenVertex p;
    if (random.chance(0.5)) {
      p = {random.in(x0 / step, x1 / step) * step, random.in(y0 / step, y1 / step) * step};
    } else {  // a pixel centre within the triangle's box
      p = {random.in(x0 >> 8, x1 >> 8) * 256 + 128, random.in(y0 >> 8, y1 >> 8) * 256 + 128};
    }
    const auto s0 = area2(o[0], o[1], p);
    const auto s1 = area2(o[1], o[2], p);
    const auto s2 = area2(o[2], o[0], p);
    if (!((s0 > 0 && s1 > 0 && s2 > 0) || (s0 < 0 && s1 < 0 && s2 < 0))) continue;  // outside or on an edge
    t[at] = {o[0], o[1], p};
    t.push_back({o[1], o[2], p});
    t.push_back({o[2], o[0], p});
  }
  return t;
}

/// A frame of drawn polygons. Planes are in LSB.
class FrameBuilder {
 public:
  FrameBuilder(int width, int height) {
    g_.width = width;
    g_.height = height;
  }

  FrameBuilder& add(const Outline& o, const ScreenPlane& depth, std::array<std::uint8_t, 3> color = {}) {
    ScreenPolygon p;
    p.first_vertex = static_cast<std::uint32_t>(g_.vertices.size());
    p.vertex_count = static_cast<std::uint32_t>(o.size());
    p.depth = depth;
    p.color = color;
    g_.vertices.insert(g_.vertices.end(), o.begin(), o.end());
    g_.polygons.push_back(p);
    g_.drawn = static_cast<std::uint32_t>(g_.polygons.size());
    return *this;
  }

  [[nodiscard]] const FrameGeometry& frame() const { return g_; }
  FrameGeometry& frame() { return g_; }

 private:
  FrameGeometry g_;
};

/// A plane with value z at the centre of pixel (x0, y0) and slopes a, b, all in LSB.
inline ScreenPlane plane(double z, double a = 0, double b = 0, int x0 = 0, int y0 = 0) {
  const auto fixed = [](double v) { return static_cast<std::int64_t>(v * (1 << kPlaneFrac)); };
  return {fixed(a), fixed(b), fixed(z), x0, y0};
}

/// A rectangle in whole pixels.
inline Outline rectangle(int x0, int y0, int x1, int y1) {
  return {{256 * x0, 256 * y0}, {256 * x0, 256 * y1}, {256 * x1, 256 * y1}, {256 * x1, 256 * y0}};
}

}  // namespace kage::verif
