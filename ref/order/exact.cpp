// SPDX-License-Identifier: Apache-2.0
#include "order/exact.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

namespace kage::order {
namespace {

namespace mp = boost::multiprecision;
using Wide = mp::number<mp::cpp_int_backend<>, mp::et_off>;
// Below 2^61 on the grid, differences are below 2^62, degree 9 needs 9 * 62 bits and a few for the sums.
using Narrow = mp::number<mp::cpp_int_backend<768, 768, mp::signed_magnitude, mp::unchecked, void>, mp::et_off>;

template <class Int>
using Point = std::array<Int, 3>;

template <class Int>
struct Plane {
  Point<Int> a;
  Point<Int> normal;
};

/// Exponent of the lowest bit set; the largest int for 0.
int lowest_bit(double x) {
  if (x == 0) return std::numeric_limits<int>::max();
  int exponent = 0;
  const double m = std::frexp(x, &exponent);
  const auto digits = static_cast<std::int64_t>(std::ldexp(std::abs(m), 53));
  return exponent - 53 + __builtin_ctzll(static_cast<std::uint64_t>(digits));
}

template <class Int>
Int on_grid(double x, const Grid& grid) {
  if constexpr (std::is_same_v<Int, Narrow>) {
    return Narrow(static_cast<std::int64_t>(std::ldexp(x, -grid.exponent)));
  } else {
    if (x == 0) return Wide(0);
    int exponent = 0;
    const double m = std::frexp(x, &exponent);
    const auto digits = static_cast<std::int64_t>(std::ldexp(m, 53));
    const int shift = exponent - 53 - grid.exponent;
    if (shift <= 0) return Wide(digits / (std::int64_t{1} << -shift));  // exact: those bits are 0
    Wide v(digits);
    v <<= static_cast<unsigned>(shift);
    return v;
  }
}

template <class Int>
Point<Int> on_grid(const OrderPoint& p, const Grid& grid) {
  return {on_grid<Int>(p[0], grid), on_grid<Int>(p[1], grid), on_grid<Int>(p[2], grid)};
}

template <class Int>
Point<Int> minus(const Point<Int>& p, const Point<Int>& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

template <class Int>
Point<Int> cross(const Point<Int>& p, const Point<Int>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

template <class Int>
Int dot(const Point<Int>& p, const Point<Int>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

template <class Int>
Plane<Int> on_grid(const PlanePoints& p, const Grid& grid) {
  const Point<Int> a = on_grid<Int>(p.a, grid);
  return {a, cross<Int>(minus<Int>(on_grid<Int>(p.b, grid), a), minus<Int>(on_grid<Int>(p.c, grid), a))};
}

/// Positive before the plane; linear in p.
template <class Int>
Int value(const Plane<Int>& plane, const Point<Int>& p) {
  return dot<Int>(plane.normal, minus<Int>(p, plane.a));
}

template <class Int>
int sign(const Int& x) {
  return x.sign();
}

template <class Int>
int side(const Grid& grid, const ExactVertex& v, const PlanePoints& plane) {
  const Plane<Int> q = on_grid<Int>(plane, grid);
  if (v.kind == ExactVertex::Kind::kCorner) return sign<Int>(value<Int>(q, on_grid<Int>(v.p, grid)));
  const Plane<Int> first = on_grid<Int>(v.first, grid);
  if (v.kind == ExactVertex::Kind::kOnEdge) {
    // The point is (s p' - s' p) / (s - s') with s, s' the plane's values at the ends p, p'.
    const Point<Int> p = on_grid<Int>(v.p, grid);
    const Point<Int> p2 = on_grid<Int>(v.q, grid);
    const Int s = value<Int>(first, p);
    const Int s2 = value<Int>(first, p2);
    return sign<Int>(s * value<Int>(q, p2) - s2 * value<Int>(q, p)) * sign<Int>(s - s2);
  }
  // Barycentric in the face's three points, a plane's value is linear: the point is where both nodes' rows are 0.
  const Plane<Int> second = on_grid<Int>(v.second, grid);
  const std::array<Point<Int>, 3> corners{on_grid<Int>(v.face.a, grid), on_grid<Int>(v.face.b, grid),
                                          on_grid<Int>(v.face.c, grid)};
  const auto row = [&](const Plane<Int>& n) {
    return Point<Int>{value<Int>(n, corners[0]), value<Int>(n, corners[1]), value<Int>(n, corners[2])};
  };
  const Point<Int> both = cross<Int>(row(first), row(second));
  return sign<Int>(dot<Int>(row(q), both)) * sign<Int>(Int(both[0] + both[1] + both[2]));
}

}  // namespace

Grid grid_of(std::span<const OrderPoint> points) {
  Grid grid{std::numeric_limits<int>::max(), true};
  double largest = 0;
  for (const OrderPoint& p : points)
    for (const double x : p) {
      grid.exponent = std::min(grid.exponent, lowest_bit(x));
      largest = std::max(largest, std::abs(x));
    }
  if (grid.exponent == std::numeric_limits<int>::max()) grid.exponent = 0;
  // frexp: largest < 2^e, so it is below 2^(e - exponent) steps.
  int e = 0;
  (void)std::frexp(largest, &e);
  grid.narrow = e - grid.exponent <= 61;
  return grid;
}

int exact_side(const Grid& grid, const ExactVertex& v, const PlanePoints& plane) {
  return grid.narrow ? side<Narrow>(grid, v, plane) : side<Wide>(grid, v, plane);
}

int exact_side(const PlanePoints& plane, const OrderPoint& p) {
  ExactVertex v;
  v.p = p;
  return exact_side(grid_of(std::array<OrderPoint, 4>{plane.a, plane.b, plane.c, p}), v, plane);
}

int exact_facing(const PlanePoints& plane, const OrderPoint& direction) {
  // Neither length is of account, so each may have a grid of its own.
  const Plane<Wide> n = on_grid<Wide>(plane, grid_of(std::array<OrderPoint, 3>{plane.a, plane.b, plane.c}));
  return sign<Wide>(dot<Wide>(n.normal, on_grid<Wide>(direction, grid_of(std::array<OrderPoint, 1>{direction}))));
}

std::array<int, 3> exact_turn(const OrderPoint& a, const OrderPoint& b, const OrderPoint& c) {
  const Plane<Wide> n = on_grid<Wide>(PlanePoints{b, c, a}, grid_of(std::array<OrderPoint, 3>{a, b, c}));
  return {sign<Wide>(n.normal[0]), sign<Wide>(n.normal[1]), sign<Wide>(n.normal[2])};
}

}  // namespace kage::order
