// SPDX-License-Identifier: Apache-2.0
#include "geometry/plane.hpp"

#include "number/int128.hpp"

namespace kage {
namespace {

// a / b rounded to nearest, halves up, for b > 0.
Int128 divide_round(Int128 a, Int128 b) {
  const Int128 n = 2 * a + b;
  const Int128 d = 2 * b;
  const Int128 q = n / d;
  return n % d < 0 ? q - 1 : q;
}

}  // namespace

DepthVertex on_plane(const ScreenPlane& plane, const ScreenVertex& at) {
  // In 2^-24 LSB a pixel times 1/256 pixel.
  const Int128 off = Int128{plane.a} * (std::int64_t{at.x} - 256 * std::int64_t{plane.x0} - 128) +
                     Int128{plane.b} * (std::int64_t{at.y} - 256 * std::int64_t{plane.y0} - 128);
  const Int128 z = divide_round((Int128{plane.c} << 8) + off, Int128{1} << (kPlaneFrac - kVertexFrac + 8));
  // A plane that is steep may leave all bounds within the half subpixel that the snap moved its vertex.
  constexpr Int128 kMost = Int128{1} << (28 + kVertexFrac);
  return {at, static_cast<std::int64_t>(z < -kMost ? -kMost : z > kMost ? kMost : z)};
}

std::int64_t double_area(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c) {
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) - (std::int64_t{c.x} - a.x) * (std::int64_t{b.y} - a.y);
}

std::optional<ScreenPlane> plane_through(const std::array<DepthVertex, 3>& v) {
  std::int64_t area = double_area(v[0].at, v[1].at, v[2].at);
  if (area == 0) return std::nullopt;
  const std::int64_t dx1 = std::int64_t{v[1].at.x} - v[0].at.x;
  const std::int64_t dy1 = std::int64_t{v[1].at.y} - v[0].at.y;
  const std::int64_t dx2 = std::int64_t{v[2].at.x} - v[0].at.x;
  const std::int64_t dy2 = std::int64_t{v[2].at.y} - v[0].at.y;
  // Positions have 25 bits with their differences, depths 28 + 16 + 1: products stay below 2^71.
  const Int128 dz1 = v[1].z - v[0].z;
  const Int128 dz2 = v[2].z - v[0].z;
  Int128 a = dz1 * dy2 - dz2 * dy1;
  Int128 b = dz2 * dx1 - dz1 * dx2;
  if (area < 0) {
    area = -area;
    a = -a;
    b = -b;
  }
  // From 2^-16 LSB a subpixel to 2^-24 LSB a pixel.
  constexpr Int128 kScale = Int128{1} << (kPlaneFrac - kVertexFrac + 8);
  a = divide_round(a * kScale, area);
  b = divide_round(b * kScale, area);
  constexpr Int128 kMost = Int128{1} << 60;
  if (a < -kMost || a > kMost || b < -kMost || b > kMost) return std::nullopt;
  ScreenPlane p;
  p.a = static_cast<std::int64_t>(a);
  p.b = static_cast<std::int64_t>(b);
  p.x0 = v[0].at.x >> 8;
  p.y0 = v[0].at.y >> 8;
  const Int128 off = a * (256 * p.x0 + 128 - v[0].at.x) + b * (256 * p.y0 + 128 - v[0].at.y);
  p.c = static_cast<std::int64_t>((Int128{v[0].z} << (kPlaneFrac - kVertexFrac)) + ((off + 128) >> 8));
  return p;
}

}  // namespace kage
