// SPDX-License-Identifier: Apache-2.0
// Written by tools/area from constraints/cells.json: 188 cores, counted by Yosys 0.23 (git sha1 7ce5011c24b).
// clang-format off
#pragma once

#include <array>

#include "cost/cells.hpp"

namespace kage {

/// Cells for one of each of so many terms, and how far their sum is off, as a share, at most.
template <std::size_t N>
struct CellFit {
  std::array<double, N> luts;
  std::array<double, N> flip_flops;
  double luts_spread;
  double flip_flops_spread;
};

inline constexpr CellFit<17> kBankedFit{{182.613, 268.667, 8.69745, 16.1182, 0, 0, 61.2384, 0, 9.97322, 2.24549, 2.96403, 23.4559, 81.5462, 0, 0.39369, 728.011, 0}, {834.371, 0, 0.815346, 26.1774, 17.9474, 0, 38.3311, 6.24266, 9.78145, 0, 1.69904, 0, 24.0482, 0, 0.391644, 284.478, 1.25784}, 0.15, 0.08};
inline constexpr CellFit<17> kSystolicFit{{0, 0, 0, 106.697, 14.9827, 22.3758, 118.444, 0, 3.85021, 0.98169, 0, 0, 90.3429, 0, 0, 0, 4.13438}, {740.906, 0, 0.0018017, 23.1658, 21.0046, 16.6433, 0, 76.8507, 2.97618, 0.0126084, 0, 0, 2.64428, 0, 0, 0, 2.31709}, 0.16, 0.02};
inline constexpr CellFit<4> kFrontEndFit{{6500.54, 0.960604, 0, 2.74827}, {5522.26, 8.80145, 0, 7.14941}, 0.07, 0.03};
inline constexpr CellFit<2> kLinearFit{{402.474, 11.4353}, {145.491, 6.8519}, 0.12, 0.1};

}  // namespace kage
