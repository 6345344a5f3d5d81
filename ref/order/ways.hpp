// SPDX-License-Identifier: Apache-2.0
// The ways to the order, a file each.
#pragma once

#include <memory>

#include "order/data.hpp"

namespace kage::order {

std::unique_ptr<VisibilityOrder> make_recursion(const TreeData& data);
std::unique_ptr<VisibilityOrder> make_switching_list(const TreeData& data);
std::unique_ptr<VisibilityOrder> make_fast(const TreeData& data);

/// Bytes of what the tree holds by node: sizes, planes, first fragments; `vectors`: the planes for the vector test too.
std::uint64_t tree_bytes(const TreeData& data, bool vectors);

}  // namespace kage::order
