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

/// The point as weights of known points: the sum of weight[i] * point[i] over the sum of the weights.
template <class Int>
struct Weighted {
  Point<Int> weight;
  std::array<Point<Int>, 3> point;
  [[nodiscard]] Int sum() const { return weight[0] + weight[1] + weight[2]; }
};

template <class Int>
Weighted<Int> weighted(const Grid& grid, const ExactVertex& v) {
  const Plane<Int> first = on_grid<Int>(v.first, grid);
  if (v.kind == ExactVertex::Kind::kOnEdge) {
    // (s p' - s' p) / (s - s') with s, s' the plane's values at the ends p, p'.
    const Point<Int> p = on_grid<Int>(v.p, grid);
    const Point<Int> q = on_grid<Int>(v.q, grid);
    return {{Int(-value<Int>(first, q)), value<Int>(first, p), Int(0)}, {p, q, p}};
  }
  // Barycentric in the face's three points, a plane's value is linear: the point is where both nodes' rows are 0.
  const Plane<Int> second = on_grid<Int>(v.second, grid);
  const std::array<Point<Int>, 3> corners{on_grid<Int>(v.face.a, grid), on_grid<Int>(v.face.b, grid),
                                          on_grid<Int>(v.face.c, grid)};
  const auto row = [&](const Plane<Int>& n) {
    return Point<Int>{value<Int>(n, corners[0]), value<Int>(n, corners[1]), value<Int>(n, corners[2])};
  };
  return {cross<Int>(row(first), row(second)), corners};
}

template <class Int>
int side(const Grid& grid, const ExactVertex& v, const PlanePoints& plane) {
  const Plane<Int> q = on_grid<Int>(plane, grid);
  if (v.kind == ExactVertex::Kind::kCorner) return sign<Int>(value<Int>(q, on_grid<Int>(v.p, grid)));
  const Weighted<Int> w = weighted<Int>(grid, v);
  Int sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += w.weight[i] * value<Int>(q, w.point[i]);
  return sign<Int>(sum) * sign<Int>(w.sum());
}

/// Cut off after 64 bits or so.
template <class Int>
double quotient(Int dividend, Int divisor) {
  if (dividend.is_zero()) return 0;
  const bool negative = (dividend.sign() < 0) != (divisor.sign() < 0);
  dividend = abs(dividend);
  divisor = abs(divisor);
  const int shift = 64 - static_cast<int>(msb(dividend)) + static_cast<int>(msb(divisor));
  if (shift >= 0)
    dividend <<= static_cast<unsigned>(shift);
  else
    divisor <<= static_cast<unsigned>(-shift);
  const double x = std::ldexp(Int(dividend / divisor).template convert_to<double>(), -shift);
  return negative ? -x : x;
}

template <class Int>
OrderPoint point(const Grid& grid, const ExactVertex& v) {
  const Weighted<Int> w = weighted<Int>(grid, v);
  OrderPoint p{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Int sum = w.weight[0] * w.point[0][k] + w.weight[1] * w.point[1][k] + w.weight[2] * w.point[2][k];
    p[k] = std::ldexp(quotient<Int>(sum, w.sum()), grid.exponent);
  }
  return p;
}

/// digits * 2^exponent, digits 1/2 .. 1 or 0, within 2^-52 of its size.
struct Rounded {
  double digits = 0;
  int exponent = 0;
};

Rounded rounded(Wide x) {
  if (x.is_zero()) return {};
  const bool negative = x.sign() < 0;
  x = abs(x);
  const int bits = static_cast<int>(msb(x)) + 1;
  const int dropped = std::max(bits - 64, 0);
  x >>= static_cast<unsigned>(dropped);
  int exponent = 0;
  const double digits = std::frexp(x.convert_to<double>(), &exponent);
  return {negative ? -digits : digits, exponent + dropped};
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

OrderPoint exact_point(const Grid& grid, const ExactVertex& v) {
  return grid.narrow ? point<Narrow>(grid, v) : point<Wide>(grid, v);
}

int exact_facing(const PlanePoints& plane, const OrderPoint& direction) {
  // Neither length is of account, so each may have a grid of its own.
  const Plane<Wide> n = on_grid<Wide>(plane, grid_of(std::array<OrderPoint, 3>{plane.a, plane.b, plane.c}));
  return sign<Wide>(dot<Wide>(n.normal, on_grid<Wide>(direction, grid_of(std::array<OrderPoint, 1>{direction}))));
}

OrderPoint exact_meeting(const PlanePoints& face, const PlanePoints& node, const Picture& picture) {
  // Lengths in space are on one grid, the axes on another.
  const Grid space = grid_of(std::array<OrderPoint, 7>{face.a, face.b, face.c, node.a, node.b, node.c, picture.eye});
  const Grid axes = grid_of(std::array<OrderPoint, 3>{picture.right, picture.up, picture.forward});
  const Plane<Wide> n = on_grid<Wide>(node, space);
  const Plane<Wide> m = on_grid<Wide>(face, space);
  const Point<Wide> eye = on_grid<Wide>(picture.eye, space);
  const Wide dn = value<Wide>(n, eye);
  const Wide dm = value<Wide>(m, eye);
  Point<Wide> along_n;
  Point<Wide> along_m;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point<Wide> axis = on_grid<Wide>(k == 0 ? picture.right : k == 1 ? picture.up : picture.forward, axes);
    along_n[k] = dot<Wide>(n.normal, axis);
    along_m[k] = dot<Wide>(m.normal, axis);
  }
  // Parallel: a length in space more in the last, an axis less.
  std::array<Rounded, 3> l;
  for (std::size_t k = 0; k < 3; ++k)
    l[k] = picture.perspective ? rounded(dm * along_n[k] - dn * along_m[k])
           : k < 2             ? rounded(along_m[2] * along_n[k] - along_n[2] * along_m[k])
                               : rounded(along_m[2] * dn - along_n[2] * dm);
  if (!picture.perspective) l[2].exponent += space.exponent - axes.exponent;
  int largest = std::numeric_limits<int>::min();
  for (const Rounded& r : l)
    if (r.digits != 0) largest = std::max(largest, r.exponent);
  OrderPoint result{};
  for (std::size_t k = 0; k < 3; ++k)
    if (l[k].digits != 0) result[k] = std::ldexp(l[k].digits, l[k].exponent - largest);
  return result;
}

std::array<int, 3> exact_turn(const OrderPoint& a, const OrderPoint& b, const OrderPoint& c) {
  const Plane<Wide> n = on_grid<Wide>(PlanePoints{b, c, a}, grid_of(std::array<OrderPoint, 3>{a, b, c}));
  return {sign<Wide>(n.normal[0]), sign<Wide>(n.normal[1]), sign<Wide>(n.normal[2])};
}

}  // namespace kage::order
