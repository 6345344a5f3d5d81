// SPDX-License-Identifier: Apache-2.0
#include "scene/functions.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/transform.hpp"
#include "test/support/catch.hpp"

namespace portable = kage::portable;
using namespace kage::scene;

namespace {

// The reference is the long double of libm, 64 bits of mantissa.
template <typename Ours, typename Reference>
double largest_error(double from, double to, Ours ours, Reference reference) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> in(from, to);
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double x = in(random);
    worst = std::max(worst, static_cast<double>(
                                std::abs(static_cast<long double>(ours(x)) - reference(static_cast<long double>(x)))));
  }
  return worst;
}

long double sin_l(long double x) { return std::sin(x); }
long double cos_l(long double x) { return std::cos(x); }

}  // namespace

TEST_CASE("sine and cosine stay within the stated error") {
  for (const double range : {1.0, 10.0, 1000.0, 1048576.0}) {
    const double s = largest_error(-range, range, portable::sin, sin_l);
    const double c = largest_error(-range, range, portable::cos, cos_l);
    INFO("|x| <= " << range << ": sin " << s << ", cos " << c);
    CHECK(s < 4e-16);
    CHECK(c < 4e-16);
  }
}

TEST_CASE("tangent and arctangent agree with libm") {
  const double t = largest_error(
      -1.5, 1.5, [](double x) { return portable::tan(x) * std::cos(x); }, [](long double x) { return std::sin(x); });
  CHECK(t < 1e-15);
  double worst = 0;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> in(-1, 1);
  std::uniform_int_distribution<int> exponent(-40, 40);
  for (int i = 0; i < 200000; ++i) {
    const double y = std::ldexp(in(random), exponent(random));
    const double x = std::ldexp(in(random), exponent(random));
    const long double truth = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    worst = std::max(worst,
                     static_cast<double>(std::abs((static_cast<long double>(portable::atan2(y, x)) - truth) / truth)));
  }
  INFO("relative error of atan2: " << worst);
  CHECK(worst < 1e-15);
}

TEST_CASE("special angles") {
  CHECK(portable::sin(0) == 0);
  CHECK(portable::cos(0) == 1);
  CHECK(portable::tan(0) == 0);
  CHECK(portable::atan2(0, 0) == 0);
  CHECK(portable::atan2(0, 1) == 0);
  CHECK(portable::atan2(0, -1) == portable::kPi);
  CHECK(portable::atan2(1, 0) == portable::kPi / 2);
  CHECK(portable::atan2(-1, 0) == -portable::kPi / 2);
  CHECK(std::abs(portable::atan2(1, 1) - portable::kPi / 4) < 2e-16);
  CHECK(std::abs(portable::cos(portable::kPi / 2)) < 1e-16);
  CHECK(portable::cos(portable::kPi) == -1);
}

TEST_CASE("slerp turns at constant speed, the shorter way") {
  const auto about_z = [](double angle) {
    return Quaternion{0, 0, portable::sin(angle / 2), portable::cos(angle / 2)};
  };
  const Quaternion a = about_z(0.3);
  const Quaternion b = about_z(2.1);
  for (const double u : {0.0, 0.125, 0.5, 0.75, 1.0}) {
    const Quaternion q = slerp(a, b, u);
    const Quaternion wanted = about_z(0.3 + 1.8 * u);
    CHECK(std::abs(q.z - wanted.z) < 4e-16);
    CHECK(std::abs(q.w - wanted.w) < 4e-16);
  }
  // -b is the same rotation.
  const Quaternion minus{-b.x, -b.y, -b.z, -b.w};
  CHECK(slerp(a, minus, 0.25).z == slerp(a, b, 0.25).z);
  // Equal and nearly equal ends.
  CHECK(slerp(a, a, 0.5).w == Approx(a.w).epsilon(1e-15));
  const Quaternion near = about_z(0.3 + 1e-10);
  CHECK(slerp(a, near, 0.5).z == Approx(about_z(0.3 + 5e-11).z).epsilon(1e-15));
}

TEST_CASE("affine maps compose, and normals stay square to faces") {
  const Affine m = compose({1, 2, 3}, {0, 0, portable::sin(0.5), portable::cos(0.5)}, {2, 3, -4});
  CHECK(m.determinant() == Approx(-24));
  const Affine n = compose({-1, 0, 5}, {0.5, 0.5, 0.5, 0.5}, {1, 1, 1});
  const glm::dvec3 p{0.25, -3, 7};
  CHECK(kage::length((m * n).point(p) - m.point(n.point(p))) < 1e-14);
  // A quarter turn about (1 1 1): x to y, y to z, z to x.
  CHECK(n.vector({1, 0, 0}) == glm::dvec3{0, 1, 0});
  CHECK(n.point({0, 1, 0}) == glm::dvec3{-1, 0, 6});
  // A mirroring, shearing map: the mapped normal is square to mapped tangents and on the mapped outside.
  const glm::dvec3 u{1, 0.5, 0.25};
  const glm::dvec3 v{-0.5, 2, 1};
  const glm::dvec3 normal = m.normal(cross(u, v));
  CHECK(std::abs(dot(normal, m.vector(u))) < 1e-12);
  CHECK(std::abs(dot(normal, m.vector(v))) < 1e-12);
  CHECK(dot(normal, m.vector(cross(u, v))) > 0);
}

TEST_CASE("unit vectors at the ends of the range") {
  CHECK(unit({3e200, 4e200, 0}, {0, 0, 1}) == glm::dvec3{0.6, 0.8, 0});
  CHECK(kage::length(unit({3e-200, 4e-200, 0}, {0, 0, 1})) == Approx(1).epsilon(1e-15));
  CHECK(unit({0, 0, 0}, {0, 0, 1}) == glm::dvec3{0, 0, 1});
  CHECK(unit({INFINITY, 0, 0}, {0, 0, 1}) == glm::dvec3{0, 0, 1});
}
