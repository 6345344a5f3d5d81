// SPDX-License-Identifier: Apache-2.0
//
// On which side of a node's plane the eye is: exactly, one node at a time, and what the vector test needs to know.
#pragma once

#include "order/data.hpp"
#include "order/kernels.hpp"

namespace kage::order {

class EyeSides {
 public:
  explicit EyeSides(const TreeData& data) : data_(&data) {}

  /// Throws Error if the eye is none.
  void set(const Eye& eye);

  /// Before the plane or on it.
  [[nodiscard]] bool front(std::uint32_t node);

  /// Calls of front() that integers decided.
  [[nodiscard]] std::uint64_t exact() const { return exact_; }

  /// For the planes of TreeData::blocks.
  [[nodiscard]] SideQuery query() const;

  /// How much the distance to any plane of `blocks` may have changed since the eye was `before`; infinite if nothing is
  /// known.
  [[nodiscard]] double way_from(const EyeSides& before) const;

  [[nodiscard]] const Eye& eye() const { return eye_; }

 private:
  const TreeData* data_;
  Eye eye_;
  OrderPoint at_{};    // perspective: scaled as the vertices; parallel: against the view, by a power of two
  OrderPoint unit_{};  // parallel: against the view, length 1 to 2^-51
  std::uint64_t exact_ = 0;
};

}  // namespace kage::order
