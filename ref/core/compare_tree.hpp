// SPDX-License-Identifier: Apache-2.0
//
// The tree of compare cells, level by level. [Ohno 1985: compare unit.] The golden counterpart of compare_tree.sv.
#pragma once

#include <span>
#include <vector>

#include "core/expansion_unit.hpp"

namespace kage {

/// One cell: the pixel with the least key, on equality the left one. The result takes the left one's place.
inline void compare_cell(TreeLine& left, const TreeLine& right) {
  for (std::size_t x = 0; x < left.key.size(); ++x) {
    const bool take = right.key[x] < left.key[x];
    left.attr[x] = take ? right.attr[x] : left.attr[x];
    left.key[x] = take ? right.key[x] : left.key[x];
  }
}

/// All levels: lines[0] is the result. Neighbours meet in a cell; an odd one out goes on to the next level.
inline void compare_tree(std::span<TreeLine> lines) {
  for (std::size_t step = 1; step < lines.size(); step *= 2)
    for (std::size_t i = 0; i + step < lines.size(); i += 2 * step) compare_cell(lines[i], lines[i + step]);
}

}  // namespace kage
