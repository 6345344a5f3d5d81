// SPDX-License-Identifier: Apache-2.0
//
// The side of a point by doubles, with a bound on the error that docs/order.md proves: a sign is given only where
// rounding cannot have changed it. All coordinates here are scaled by a power of two to at most 1 (Scale), and u is
// 2^-53.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "kage/order.hpp"

namespace kage::order {

/// x times 2^-exponent, so that the largest coordinate is in 1/2 .. 1. Exact down to 2^-1022; what is lost below is
/// within kTiny.
struct Scale {
  int exponent = 0;
  [[nodiscard]] OrderPoint operator()(const OrderPoint& p) const {
    return {std::ldexp(p[0], -exponent), std::ldexp(p[1], -exponent), std::ldexp(p[2], -exponent)};
  }
};

inline Scale scale_of(std::span<const OrderPoint> points) {
  double largest = 0;
  for (const OrderPoint& p : points) largest = std::max({largest, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  Scale s;
  (void)std::frexp(largest, &s.exponent);
  return s;
}

/// Larger than all that underflow can do to a value.
inline constexpr double kTiny = 0x1p-1000;

/// A point within `radius` of the true one in each coordinate.
struct NearPoint {
  OrderPoint at{};
  double radius = 0;
};

/// n . (p - a), n = (b - a) x (c - a).
class FilterPlane {
 public:
  FilterPlane() = default;
  FilterPlane(const OrderPoint& a, const OrderPoint& b, const OrderPoint& c) : a_(a) {
    const OrderPoint d{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const OrderPoint e{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const std::size_t k = (i + 2) % 3;
      const double p = d[j] * e[k];
      const double q = d[k] * e[j];
      normal_[i] = p - q;
      weight_[i] = std::abs(p) + std::abs(q);
      if (a[i] == b[i] && a[i] == c[i]) flat_ = static_cast<int>(i);
    }
    // |p - a| is at most 2 in each coordinate.
    bound_ = kFactor * 2 * (weight_[0] + weight_[1] + weight_[2]) + kTiny;
    slope_ = (std::abs(normal_[0]) + std::abs(normal_[1]) + std::abs(normal_[2])) * (1 + 0x1p-40);
  }

  [[nodiscard]] double value(const OrderPoint& p) const {
    return normal_[0] * (p[0] - a_[0]) + normal_[1] * (p[1] - a_[1]) + normal_[2] * (p[2] - a_[2]);
  }

  /// Bound of the error of value(p.at) against the true point's value; p.at is at most 1 in each coordinate.
  [[nodiscard]] double error(const NearPoint& p) const { return bound_ + slope_ * p.radius * (1 + 0x1p-40); }

  /// The same for any point without radius.
  [[nodiscard]] double error(const OrderPoint& p) const {
    return kFactor * (weight_[0] * std::abs(p[0] - a_[0]) + weight_[1] * std::abs(p[1] - a_[1]) +
                      weight_[2] * std::abs(p[2] - a_[2])) +
           kTiny;
  }

  /// n . d, and its error.
  [[nodiscard]] double slope(const OrderPoint& d) const {
    return normal_[0] * d[0] + normal_[1] * d[1] + normal_[2] * d[2];
  }
  [[nodiscard]] double slope_error(const OrderPoint& d) const {
    return kFactor * (weight_[0] * std::abs(d[0]) + weight_[1] * std::abs(d[1]) + weight_[2] * std::abs(d[2])) + kTiny;
  }

  /// The axis that the plane is perpendicular to, as its three points show, or -1.
  [[nodiscard]] int flat() const { return flat_; }
  [[nodiscard]] const OrderPoint& origin() const { return a_; }
  [[nodiscard]] const OrderPoint& normal() const { return normal_; }
  [[nodiscard]] const OrderPoint& weight() const { return weight_; }

 private:
  static constexpr double kFactor = 0x1p-49;  // 16 u; docs/order.md needs 10 u and second-order terms
  OrderPoint a_{};
  OrderPoint normal_{};
  OrderPoint weight_{};
  double bound_ = 0;
  double slope_ = 0;
  int flat_ = -1;
};

/// Where the way from p to q meets a plane; `at_p`, `at_q`: the plane's values there, `error_p`, `error_q` their
/// errors. The true values have unlike signs. The bound is docs/order.md's.
inline NearPoint meet(const NearPoint& p, double at_p, double error_p, const NearPoint& q, double at_q,
                      double error_q) {
  double way = 0;
  for (std::size_t i = 0; i < 3; ++i) way = std::max(way, std::abs(q.at[i] - p.at[i]));
  double t = 0.5;
  double error = 1;
  const double difference = std::abs(at_p - at_q);
  const double least = difference - error_p - error_q;
  if ((at_p > 0) != (at_q > 0) && least > 0) {
    t = at_p / (at_p - at_q);
    error = std::min(1.0, std::max(error_p, error_q) / least * (1 + 0x1p-40) + 0x1p-50);
  }
  NearPoint x;
  for (std::size_t i = 0; i < 3; ++i) x.at[i] = std::clamp(p.at[i] + t * (q.at[i] - p.at[i]), -1.0, 1.0);
  x.radius = (std::max(p.radius, q.radius) + error * way + 0x1p-49) * (1 + 0x1p-40);
  return x;
}

}  // namespace kage::order
