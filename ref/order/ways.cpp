// SPDX-License-Identifier: Apache-2.0
#include "order/ways.hpp"

namespace kage {

std::unique_ptr<VisibilityOrder> make_order(const OrderTree& tree, OrderWay way) {
  switch (way) {
    case OrderWay::recursion:
      return order::make_recursion(order::data_of(tree));
    case OrderWay::switching_list:
      return order::make_switching_list(order::data_of(tree));
    case OrderWay::fast:
      break;
  }
  return order::make_fast(order::data_of(tree));
}

namespace order {

std::uint64_t tree_bytes(const TreeData& data, bool vectors) {
  const std::uint64_t words = data.size.size() + data.plane.size() + data.first_fragment.size();
  return words * sizeof(std::uint32_t) + (vectors ? data.blocks.size() * sizeof(float) : 0);
}

}  // namespace order
}  // namespace kage
