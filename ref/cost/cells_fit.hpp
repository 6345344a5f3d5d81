// SPDX-License-Identifier: Apache-2.0
// Written by tools/area from constraints/cells.json: 120 cores, counted by Yosys 0.23 (git sha1 7ce5011c24b).
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

inline constexpr CellFit kBankedFit{{335.706, 279.631, 5.28327, 21.2891, 0, 0, 91.8154, 0, 6.49737, 4.94263, 5.18238, 94.1347, 0, 0.65005, 727.989, 0}, {704.061, 0, 0.580159, 28.6087, 18.6507, 0, 42.8556, 57.4203, 4.96625, 2.65302, 2.88848, 20.0273, 3.74323, 0.474283, 138.938, 1.86908}, 0.15, 0.07};
inline constexpr CellFit kSystolicFit{{0, 0, 0, 106.697, 14.9827, 22.3758, 118.444, 0, 3.85021, 0.98169, 0, 90.3429, 0, 0, 0, 4.13438}, {763.151, 2.87966e-13, 0.0017949, 23.0195, 21.0057, 16.6439, 0, 75.4651, 2.97587, 0.0219067, 0, 2.64544, 0, 0, 0, 2.31717}, 0.16, 0.02};

}  // namespace kage
