// SPDX-License-Identifier: Apache-2.0
//
// Where a scene's points lie on the screen before the snap, and how deep: transform, clipping, projection and depth in
// floating point of 333 bits, which shares no arithmetic with the golden model.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <utility>
#include <vector>

#include "kage/geometry.hpp"

namespace kage::verif {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

/// A point from the eye: right, up and forward.
struct PrecisePoint {
  Real x, y, w;
};

class ExactScreen {
 public:
  ExactScreen(const Camera& c, int width, int height) : camera_(c), width_(width), height_(height) {}

  [[nodiscard]] PrecisePoint point(const glm::dvec3& world) const {
    const Real x = Real(world.x) - Real(camera_.eye.x);
    const Real y = Real(world.y) - Real(camera_.eye.y);
    const Real z = Real(world.z) - Real(camera_.eye.z);
    const auto along = [&](const glm::dvec3& a) { return x * Real(a.x) + y * Real(a.y) + z * Real(a.z); };
    return {along(camera_.right), along(camera_.up), along(camera_.forward)};
  }

  [[nodiscard]] Real scale(const PrecisePoint& p) const { return camera_.perspective ? p.w : Real(1); }

  /// The place on the screen, in pixels, times scale().
  [[nodiscard]] Real x(const PrecisePoint& p) const {
    return p.x * half(height_) / half_height() + scale(p) * half(width_);
  }
  [[nodiscard]] Real y(const PrecisePoint& p) const {
    return scale(p) * half(height_) - p.y * half(height_) / half_height();
  }

  /// Its depth in LSB of `z_bits` bits, which go from 1 at `near` to the last but one at `far`.
  [[nodiscard]] Real depth(const PrecisePoint& p, double near, double far, int z_bits) const {
    const Real range((std::int64_t{1} << z_bits) - 3);
    const Real linear = range * (p.w - Real(near)) / (Real(far) - Real(near));
    return 1 + (camera_.perspective ? linear * Real(far) / p.w : linear);
  }

  [[nodiscard]] ScreenVertex snap(const PrecisePoint& p) const {
    const auto rounded = [](const Real& v) {
      const Real half_up = v * 256 + Real(0.5);
      return static_cast<std::int32_t>(Real(floor(half_up + kExact)).convert_to<double>());
    };
    return {rounded(x(p) / scale(p)), rounded(y(p) / scale(p))};
  }

  /// Keeps the part of a polygon within the guard band and from `near` on.
  void clip(std::vector<PrecisePoint>& polygon, double near) const {
    const Real limit = kGuard;
    cut(polygon, [&](const PrecisePoint& p) { return p.w - Real(near); });
    cut(polygon, [&](const PrecisePoint& p) { return y(p) + limit * scale(p); });
    cut(polygon, [&](const PrecisePoint& p) { return limit * scale(p) - y(p); });
    cut(polygon, [&](const PrecisePoint& p) { return x(p) + limit * scale(p); });
    cut(polygon, [&](const PrecisePoint& p) { return limit * scale(p) - x(p); });
  }

  /// Keeps the part of a polygon no further than `end`.
  static void cut_behind(std::vector<PrecisePoint>& polygon, const Real& end) {
    cut(polygon, [&](const PrecisePoint& p) { return end - p.w; });
  }

  /// Keeps the part of a polygon in the picture and from `near` on.
  void to_picture(std::vector<PrecisePoint>& polygon, double near) const {
    cut(polygon, [&](const PrecisePoint& p) { return p.w - Real(near); });
    cut(polygon, [&](const PrecisePoint& p) { return y(p); });
    cut(polygon, [&](const PrecisePoint& p) { return height_ * scale(p) - y(p); });
    cut(polygon, [&](const PrecisePoint& p) { return x(p); });
    cut(polygon, [&](const PrecisePoint& p) { return width_ * scale(p) - x(p); });
  }

 private:
  // Positions are quotients of numbers with some 110 bits, those of corners that clipping makes with up to some 330.
  // One so close to half a subpixel is there exactly, and is rounded up.
  static inline const Real kExact{"1e-85"};

  static Real half(int size) { return Real(size) / 2; }
  [[nodiscard]] Real half_height() const { return Real(camera_.half_height); }

  // Keeps the part of a polygon that has inside(p) >= 0.
  template <class Inside>
  static void cut(std::vector<PrecisePoint>& polygon, Inside inside) {
    std::vector<PrecisePoint> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const PrecisePoint& a = polygon[i];
      const PrecisePoint& b = polygon[(i + 1) % polygon.size()];
      const Real da = inside(a);
      const Real db = inside(b);
      if (da >= 0) kept.push_back(a);
      if ((da >= 0) == (db >= 0)) continue;
      const Real t = da / (da - db);
      kept.push_back({a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.w + t * (b.w - a.w)});
    }
    polygon = std::move(kept);
  }

  Camera camera_;
  int width_;
  int height_;
};

}  // namespace kage::verif
