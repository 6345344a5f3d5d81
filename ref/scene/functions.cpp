// SPDX-License-Identifier: Apache-2.0
#include "functions.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace kage::portable {
namespace {

// Taylor coefficients suffice: the argument is at most pi/4, where the first term left out, x^19/19! or x^20/20!, is
// below 1e-19 of the result.
constexpr int kTerms = 9;

constexpr std::array<double, kTerms> taylor(int first) {
  std::array<double, kTerms> c{};
  double factorial = 1;  // exact up to 18!, and rounded once in the division
  int n = 1;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (; n <= first + 2 * static_cast<int>(i); ++n) factorial *= n;
    c[i] = (i % 2 == 0 ? 1.0 : -1.0) / factorial;
  }
  return c;
}

constexpr auto kSin = taylor(3);  // x^3/3! - x^5/5! + ...
constexpr auto kCos = taylor(4);  // x^4/4! - x^6/6! + ...

double horner(const std::array<double, kTerms>& c, double z) {
  double sum = c[kTerms - 1];
  for (std::size_t i = kTerms - 1; i-- > 0;) sum = sum * z + c[i];
  return sum;
}

// x + tail, |x| <= pi/4, |tail| far below ulp(x).
double sin_kernel(double x, double tail) {
  const double z = x * x;
  return x + (tail * (1 - 0.5 * z) - x * (z * horner(kSin, z)));
}

double cos_kernel(double x, double tail) {
  const double z = x * x;
  const double half = 0.5 * z;
  const double big = 1 - half;
  // (1 - big) - half is the rounding error of `big`, exactly.
  return big + (((1 - big) - half) + (z * (z * horner(kCos, z)) - x * tail));
}

struct Reduced {
  int quadrant;
  double x;
  double tail;
};

// Cody and Waite: x - n pi/2 with pi/2 in three parts of 33, 33 and 53 bits. n has at most 20 bits, so that the
// products with the first two parts are exact.
Reduced reduce(double x) {
  constexpr double kPart1 = 0x1.921fb544p+0;
  constexpr double kPart2 = 0x1.0b4611a6p-34;
  constexpr double kPart3 = 0x1.3198a2e037073p-69;
  const double n = std::floor(x * (2 / kPi) + 0.5);
  const double a = x - n * kPart1;
  const double b = n * kPart2;
  const double r = a - b;
  const double tail = ((a - r) - b) - n * kPart3;
  const double sum = r + tail;
  return {static_cast<int>(static_cast<long long>(n) & 3), sum, (r - sum) + tail};
}

// atan of 0 <= x <= 1. Two halvings, atan x = 2 atan(x / (1 + sqrt(1 + x^2))), bring it below tan(pi/16).
double atan_unit(double x) {
  x = x / (1 + std::sqrt(1 + x * x));
  x = x / (1 + std::sqrt(1 + x * x));
  const double z = x * x;
  double sum = 0;
  for (int k = 25; k >= 3; k -= 2) sum = 1.0 / k - z * sum;
  return 4 * (x - x * (z * sum));
}

}  // namespace

double sin(double x) {
  const Reduced r = reduce(x);
  const double s = (r.quadrant & 1) != 0 ? cos_kernel(r.x, r.tail) : sin_kernel(r.x, r.tail);
  return (r.quadrant & 2) != 0 ? -s : s;
}

double cos(double x) {
  const Reduced r = reduce(x);
  const double c = (r.quadrant & 1) != 0 ? sin_kernel(r.x, r.tail) : cos_kernel(r.x, r.tail);
  return r.quadrant == 1 || r.quadrant == 2 ? -c : c;
}

double tan(double x) { return sin(x) / cos(x); }

double atan2(double y, double x) {
  const double ax = x < 0 ? -x : x;
  const double ay = y < 0 ? -y : y;
  if (ax == 0 && ay == 0) return 0;
  double angle = ay <= ax ? atan_unit(ay / ax) : kPi / 2 - atan_unit(ax / ay);
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace kage::portable
