// SPDX-License-Identifier: Apache-2.0
//
// Frames made of screen polygons by hand, and hit counts.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "frontend/scan.hpp"
#include "kage/geometry.hpp"

namespace kage::verif {

using Outline = std::vector<ScreenVertex>;

/// How often each pixel of a width x height screen is hit.
class Hits {
 public:
  Hits(int width, int height)
      : width_(width), height_(height), count_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  /// `wider` pixels are added at the right end of each run of three pixels or more, for tests that must see it.
  void add(const Outline& o, int wider = 0) {
    scanner_.scan(o, 0, height_, width_, [&](int y, int xl, int xr, int) {
      for (int x = xl; x < (xr - xl >= 3 ? std::min(width_, xr + wider) : xr); ++x)
        ++count_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    });
  }

  [[nodiscard]] int at(int x, int y) const {
    return count_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  }
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
