// SPDX-License-Identifier: Apache-2.0
// Written by tools/area from constraints/cells.json: 49 cores, counted by Yosys 0.23 (git sha1 7ce5011c24b).
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

inline constexpr CellFit kBankedFit{{1741.82, 329.641, 0, 13.8295, 0, 10.3937, 0, 0, 11.1686, 0, 2.581, 121.339, 0, 0.592298, 234.438, 2.4426}, {1118.38, 25.2512, 0.867832, 23.6361, 16.5881, 0, 4.72825, 0, 6.82884, 0, 2.43538, 21.4002, 6.12435, 0.430193, 136.799, 1.90018}, 0.12, 0.05};
inline constexpr CellFit kSystolicFit{{7463, 2.0714e-13, 7.18661e-31, 2.76021e-46, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {5707, 1.58401e-13, 5.49564e-31, 2.11075e-46, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 0.01, 0.01};

}  // namespace kage
