// SPDX-License-Identifier: Apache-2.0
// Written by tools/area from constraints/cells.json: 118 cores, counted by Yosys 0.23 (git sha1 7ce5011c24b).
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
inline constexpr CellFit kSystolicFit{{1630.95, 4.58869e-13, 0.00198737, 68.4785, 0, 36.3569, 0, 65.2868, 2.90948, 0.223756, 0.686683, 109.077, 0, 0.264637, 0, 0}, {452.189, 6.20173e-14, 0.00226091, 26.8328, 17.3769, 12.2392, 0, 89.9024, 2.70927, 0, 0.480102, 4.06618, 7.23287, 0, 0, 0}, 0.04, 0.01};

}  // namespace kage
