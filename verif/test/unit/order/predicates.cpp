// SPDX-License-Identifier: Apache-2.0
// The signs that the visibility order stands on, held against rational arithmetic: those by integers are always right,
// those by doubles are right or not given, and points by doubles lie within their radius.
#include <boost/multiprecision/cpp_int.hpp>
#include <string>

#include "order/exact.hpp"
#include "order/filter.hpp"
#include "stimulus/order_meshes.hpp"
#include "test/support/catch.hpp"

namespace kage::verif {
namespace {

using namespace kage::order;
using Rational = boost::multiprecision::cpp_rational;
using RationalPoint = std::array<Rational, 3>;

RationalPoint rational(const OrderPoint& p) { return {Rational(p[0]), Rational(p[1]), Rational(p[2])}; }

Rational value(const PlanePoints& plane, const RationalPoint& p) {
  const RationalPoint a = rational(plane.a);
  const RationalPoint b = rational(plane.b);
  const RationalPoint c = rational(plane.c);
  Rational sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    sum += ((b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j])) * (p[i] - a[i]);
  }
  return sum;
}

/// Where the line from p to q meets a plane that it is not parallel to.
RationalPoint meet(const RationalPoint& p, const RationalPoint& q, const PlanePoints& plane) {
  const Rational at_p = value(plane, p);
  const Rational t = at_p / (at_p - value(plane, q));
  return {p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])};
}

/// Points of all the kinds that go wrong.
OrderPoint some_point(Random& random, int kind) {
  switch (kind) {
    case 0:
      return random_point(random, 1);
    case 1:
      return lattice_point(random, 3);
    case 2: {
      OrderPoint p = lattice_point(random, 2);  // a hair off a lattice
      for (double& x : p)
        if (random.chance(0.3)) x = std::nextafter(x, random.chance(0.5) ? 10 : -10);
      return p;
    }
    case 3: {
      OrderPoint p = random_point(random, 1);  // as far apart as can be
      for (double& x : p) x = std::ldexp(x, random.in(-300, 300));
      return p;
    }
    default: {
      OrderPoint p = random_point(random, 1);  // far out, close together
      for (double& x : p) x = 1e6 + std::ldexp(x, -20);
      return p;
    }
  }
}

PlanePoints some_plane(Random& random, int kind) {
  return {some_point(random, kind), some_point(random, kind), some_point(random, kind)};
}

constexpr std::array<const char*, 5> kKinds{"random", "lattice", "near lattice", "wide range", "far out"};

}  // namespace

TEST_CASE("the side of a point: integers are right, doubles right or silent") {
  Random random(test_seed());
  CAPTURE(test_seed());
  for (int kind = 0; kind < 5; ++kind) {
    CAPTURE(kKinds[static_cast<std::size_t>(kind)]);
    int silent = 0;
    int on = 0;
    for (int i = 0; i < 3000; ++i) {
      const PlanePoints plane = some_plane(random, kind);
      OrderPoint p = some_point(random, kind);
      if (random.chance(0.2)) {  // in the plane, or as near as doubles come
        const double s = random.in(-2, 2);
        for (std::size_t k = 0; k < 3; ++k)
          p[k] = plane.a[k] + s * (plane.b[k] - plane.a[k]) + (plane.c[k] - plane.a[k]);
      }
      if (!std::isfinite(p[0] + p[1] + p[2])) continue;
      const int right = value(plane, rational(p)).sign();
      if (right == 0) ++on;
      REQUIRE(exact_side(plane, p) == right);
      const std::array<OrderPoint, 4> all{plane.a, plane.b, plane.c, p};
      ExactVertex v;
      v.p = p;
      REQUIRE(exact_side(grid_of(all), v, plane) == right);

      const Scale scale = scale_of(all);
      const FilterPlane filter(scale(plane.a), scale(plane.b), scale(plane.c));
      const double found = filter.value(scale(p));
      for (const double error : {filter.error(scale(p)), filter.error(NearPoint{scale(p), 0})}) {
        if (found > error) REQUIRE(right == 1);
        if (found < -error) REQUIRE(right == -1);
      }
      if (!(std::abs(found) > filter.error(scale(p)))) ++silent;
      // The bound is of the value, not of the sign alone.
      Rational unit = 1;
      if (scale.exponent >= 0)
        unit /= boost::multiprecision::cpp_int(1) << scale.exponent;
      else
        unit *= boost::multiprecision::cpp_int(1) << -scale.exponent;
      const Rational difference = value(plane, rational(p)) * unit * unit * unit - Rational(found);
      REQUIRE(abs(difference) <= Rational(filter.error(scale(p))));
    }
    UNSCOPED_INFO("silent " << silent << ", on the plane " << on << " of 3000");
    if (kind == 0) CHECK(silent < 700);  // those made to lie in the plane, and next to no others
    if (kind == 1) CHECK(on > 300);
  }
}

TEST_CASE("directions and turns by integers are right") {
  Random random(test_seed(2));
  CAPTURE(test_seed(2));
  for (int i = 0; i < 5000; ++i) {
    const int kind = i % 5;
    const PlanePoints plane = some_plane(random, kind);
    const OrderPoint d = some_point(random, random.in(0, 3));
    RationalPoint ahead = rational(plane.a);
    for (std::size_t k = 0; k < 3; ++k) ahead[k] += Rational(d[k]);
    REQUIRE(exact_facing(plane, d) == value(plane, ahead).sign());
    const std::array<int, 3> turn = exact_turn(plane.a, plane.b, plane.c);
    for (std::size_t k = 0; k < 3; ++k) {
      RationalPoint along = rational(plane.a);
      along[k] += 1;
      REQUIRE(turn[k] == value(plane, along).sign());
    }
  }
}

TEST_CASE("points that cuts make: signs by integers are right, doubles lie within their radius") {
  Random random(test_seed(3));
  CAPTURE(test_seed(3));
  int on_edges = 0;
  int inside = 0;
  int zeros = 0;
  for (int i = 0; i < 6000; ++i) {
    const int kind = i % 5;
    CAPTURE(i, kKinds[static_cast<std::size_t>(kind)]);
    const PlanePoints face = some_plane(random, kind);
    const PlanePoints first = some_plane(random, kind);
    const PlanePoints second = some_plane(random, kind);
    PlanePoints tested = some_plane(random, kind);
    if (random.chance(0.3)) tested.a = face.a;
    if (random.chance(0.1)) tested = {face.a, face.b, tested.c};  // holds the edge
    const std::array<RationalPoint, 3> f{rational(face.a), rational(face.b), rational(face.c)};
    std::vector<OrderPoint> all;
    for (const PlanePoints& p : {face, first, second, tested}) all.insert(all.end(), {p.a, p.b, p.c});
    const Grid grid = grid_of(all);
    const Scale scale = scale_of(all);
    const auto near_value = [&](const PlanePoints& p, const NearPoint& x) {
      const FilterPlane plane(scale(p.a), scale(p.b), scale(p.c));
      return std::pair{plane.value(x.at), plane.error(x)};
    };
    const auto cut = [&](const NearPoint& p, const NearPoint& q, const PlanePoints& plane) {
      const auto [at_p, error_p] = near_value(plane, p);
      const auto [at_q, error_q] = near_value(plane, q);
      return kage::order::meet(p, at_p, error_p, q, at_q, error_q);
    };
    const auto within = [&](const NearPoint& x, const RationalPoint& right) {
      for (std::size_t k = 0; k < 3; ++k) {
        Rational scaled = right[k];
        if (scale.exponent >= 0)
          scaled /= boost::multiprecision::cpp_int(1) << scale.exponent;
        else
          scaled *= boost::multiprecision::cpp_int(1) << -scale.exponent;
        REQUIRE(abs(scaled - Rational(x.at[k])) <= Rational(x.radius));
      }
    };
    const auto crosses = [&](const RationalPoint& p, const RationalPoint& q, const PlanePoints& plane) {
      return value(plane, p).sign() * value(plane, q).sign() < 0;
    };

    const NearPoint a{scale(face.a), 0};
    const NearPoint b{scale(face.b), 0};
    const NearPoint c{scale(face.c), 0};
    if (!crosses(f[0], f[1], first)) continue;
    ++on_edges;
    const RationalPoint x = meet(f[0], f[1], first);
    const NearPoint near_x = cut(a, b, first);
    within(near_x, x);
    ExactVertex v;
    v.kind = ExactVertex::Kind::kOnEdge;
    v.p = face.a;
    v.q = face.b;
    v.first = first;
    const int right = value(tested, x).sign();
    REQUIRE(exact_side(grid, v, tested) == right);
    if (right == 0) ++zeros;
    const auto [found, error] = near_value(tested, near_x);
    if (found > error) REQUIRE(right == 1);
    if (found < -error) REQUIRE(right == -1);

    // The cut's other end, on another edge; the second plane between the two.
    if (!crosses(f[0], f[2], first)) continue;
    const RationalPoint y = meet(f[0], f[2], first);
    if (!crosses(x, y, second)) continue;
    ++inside;
    const RationalPoint z = meet(x, y, second);
    const NearPoint near_z = cut(near_x, cut(a, c, first), second);
    within(near_z, z);
    v.kind = ExactVertex::Kind::kInside;
    v.face = face;
    v.second = second;
    const int right_z = value(tested, z).sign();
    REQUIRE(exact_side(grid, v, tested) == right_z);
    const auto [found_z, error_z] = near_value(tested, near_z);
    if (found_z > error_z) REQUIRE(right_z == 1);
    if (found_z < -error_z) REQUIRE(right_z == -1);
  }
  CHECK(on_edges > 1000);
  CHECK(inside > 100);
  CHECK(zeros > 100);
}

}  // namespace kage::verif
