// SPDX-License-Identifier: Apache-2.0
#include "order/sides.hpp"

#include <cmath>
#include <limits>

#include "kage/error.hpp"

namespace kage::order {

void EyeSides::set(const Eye& eye) {
  for (const double x : eye.at)
    if (!std::isfinite(x)) throw Error("eye: a coordinate is not finite");
  if (eye.perspective) {
    at_ = data_->faces.scale(eye.at);
  } else {
    if (eye.at == OrderPoint{0, 0, 0}) throw Error("eye: a direction without length");
    const OrderPoint against{-eye.at[0], -eye.at[1], -eye.at[2]};
    at_ = scale_of(std::array<OrderPoint, 1>{against})(against);
    const double length = std::sqrt(at_[0] * at_[0] + at_[1] * at_[1] + at_[2] * at_[2]);
    unit_ = {at_[0] / length, at_[1] / length, at_[2] / length};
  }
  eye_ = eye;
}

bool EyeSides::front(std::uint32_t node) {
  const std::array<std::uint32_t, 3> p = data_->plane_vertices(node);
  const Faces& f = data_->faces;
  const FilterPlane plane(f.scaled[p[0]], f.scaled[p[1]], f.scaled[p[2]]);
  const double value = eye_.perspective ? plane.value(at_) : plane.slope(at_);
  const double error = eye_.perspective ? plane.error(at_) : plane.slope_error(at_);
  if (value > error) return true;
  if (value < -error) return false;
  ++exact_;
  const PlanePoints points{f.vertices[p[0]], f.vertices[p[1]], f.vertices[p[2]]};
  return (eye_.perspective ? exact_side(points, eye_.at) : -exact_facing(points, eye_.at)) >= 0;
}

SideQuery EyeSides::query() const {
  OrderPoint e = unit_;
  double offset = 0;
  if (eye_.perspective) {
    for (std::size_t i = 0; i < 3; ++i) e[i] = at_[i] - data_->centre[i];
    offset = data_->radius;
  }
  SideQuery q;
  q.x = static_cast<float>(e[0]);
  q.y = static_cast<float>(e[1]);
  q.z = static_cast<float>(e[2]);
  q.w = eye_.perspective ? 1.0F : 0.0F;
  // docs/order.md: 6 * 2^-24 would do.
  q.threshold = static_cast<float>(0x1p-21 * (std::abs(e[0]) + std::abs(e[1]) + std::abs(e[2]) + offset) + 0x1p-100);
  return q;
}

double EyeSides::way_from(const EyeSides& before) const {
  if (eye_.perspective != before.eye_.perspective) return std::numeric_limits<double>::infinity();
  const OrderPoint& p = eye_.perspective ? at_ : unit_;
  const OrderPoint& q = eye_.perspective ? before.at_ : before.unit_;
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += (p[i] - q[i]) * (p[i] - q[i]);
  // Adds all that rounding and underflow can take away, here and where ways are summed up.
  const double way = std::sqrt(sum) * (1 + 0x1p-40) + 0x1p-41;
  return way < 0x1p9 ? way : std::numeric_limits<double>::infinity();
}

}  // namespace kage::order
