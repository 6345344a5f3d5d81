// SPDX-License-Identifier: Apache-2.0
// The ways to the order, a file each.
#pragma once

#include <memory>

#include "order/data.hpp"

namespace kage::order {

std::unique_ptr<VisibilityOrder> make_recursion(const OrderTree::Data& data);
std::unique_ptr<VisibilityOrder> make_switching_list(const OrderTree::Data& data);
std::unique_ptr<VisibilityOrder> make_fast(const OrderTree::Data& data);

/// Bytes of what the tree holds by node: sizes, planes, first fragments; `vectors`: the planes for the vector test too.
std::uint64_t tree_bytes(const OrderTree::Data& data, bool vectors);

}  // namespace kage::order
