// SPDX-License-Identifier: Apache-2.0
// Written by tools/area from constraints/cells.json: 123 cores, counted by Yosys 0.23 (git sha1 7ce5011c24b).
// clang-format off
#pragma once

#include <array>

#include "cost/cells.hpp"

namespace kage {

/// Cells for one of each of kCellTermInfo, and how far their sum is off, as a share, at most.
struct CellFit {
  std::array<double, kCellTerms> luts;
  std::array<double, kCellTerms> flip_flops;
  double luts_spread;
  double flip_flops_spread;
};

inline constexpr CellFit kBankedFit{{334.256, 279.817, 5.37127, 20.9437, 0, 0, 91.1641, 0, 6.50322, 4.99634, 5.14215, 93.9867, 0, 0.650776, 728.221, 0}, {830.017, 0, 0, 24.601, 18.6579, 0, 53.4135, 0, 9.80985, 0, 2.3363, 23.0826, 0.135504, 0.388689, 244.709, 1.43335}, 0.15, 0.08};
inline constexpr CellFit kSystolicFit{{1630.95, 4.58869e-13, 0.00198737, 68.4785, 0, 36.3569, 0, 65.2868, 2.90948, 0.223756, 0.686683, 109.077, 0, 0.264637, 0, 0}, {452.189, 6.20173e-14, 0.00226091, 26.8328, 17.3769, 12.2392, 0, 89.9024, 2.70927, 0, 0.480102, 4.06618, 7.23287, 0, 0, 0}, 0.04, 0.01};

}  // namespace kage
