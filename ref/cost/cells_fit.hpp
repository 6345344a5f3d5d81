// SPDX-License-Identifier: Apache-2.0
// Written by tools/area from constraints/cells.json: 125 cores, counted by Yosys 0.23 (git sha1 7ce5011c24b).
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
inline constexpr CellFit kSystolicFit{{0, 0, 0, 106.697, 14.9827, 22.3758, 118.444, 0, 3.85021, 0.98169, 0, 90.3429, 0, 0, 0, 4.13438}, {763.151, 0, 0.0017949, 23.0195, 21.0057, 16.6439, 0, 75.4651, 2.97587, 0.0219067, 0, 2.64544, 0, 0, 0, 2.31717}, 0.16, 0.02};

}  // namespace kage
