// SPDX-License-Identifier: Apache-2.0
#include "order/ways.hpp"

namespace kage {

std::unique_ptr<VisibilityOrder> make_order(const OrderTree& tree, OrderWay way) {
  switch (way) {
    case OrderWay::kRecursion:
      return order::make_recursion(tree.data());
    case OrderWay::kSwitchingList:
      return order::make_switching_list(tree.data());
    case OrderWay::kFast:
      break;
  }
  return order::make_fast(tree.data());
}

namespace order {

std::uint64_t tree_bytes(const OrderTree::Data& data, bool vectors) {
  const std::uint64_t words = data.size.size() + data.plane.size() + data.first_fragment.size();
  return words * sizeof(std::uint32_t) + (vectors ? data.blocks.size() * sizeof(float) : 0);
}

}  // namespace order
}  // namespace kage
