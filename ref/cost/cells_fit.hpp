// SPDX-License-Identifier: Apache-2.0
// Written by tools/area from what yosys counted; run that.
// clang-format off
#pragma once

#include <array>

#include "cost/cells.hpp"

namespace kage {

/// Cells for one of each of kCellTermInfo.
struct CellFit {
  std::array<double, kCellTerms> luts;
  std::array<double, kCellTerms> flip_flops;
  double luts_spread;
  double flip_flops_spread;
};

inline constexpr CellFit kBankedFit{{800, 10, 1, 10, 5, 5, 20, 30, 6, 3, 3, 200, 2, 5, 300, 1}, {800, 32, 2, 10, 5, 5, 20, 30, 6, 3, 3, 50, 2, 5, 300, 1}, 0.5, 0.5};
inline constexpr CellFit kSystolicFit{{800, 10, 1, 10, 5, 5, 20, 30, 6, 3, 3, 200, 2, 5, 300, 1}, {800, 32, 2, 10, 5, 5, 20, 30, 6, 3, 3, 50, 2, 5, 300, 1}, 0.5, 0.5};

}  // namespace kage
