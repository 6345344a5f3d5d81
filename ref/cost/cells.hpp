// SPDX-License-Identifier: Apache-2.0
//
// A core's area on an FPGA. RAM and the bits of a pixel's state follow exactly from the parameters. Look-up tables and
// flip-flops are a linear fit to what yosys counts: synthesis takes a minute, and a plan compares hundreds of cores.
// `tools/area` measures, fits and states how far the fit is off; kage area says both for one core.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "kage/config.hpp"

namespace kage {

/// Area of one core.
struct Cells {
  double luts = 0;             ///< look-up tables of four inputs on an ECP5, carry chains and LUT RAM in them
  double flip_flops = 0;       ///< of the whole core
  std::uint64_t ram_bits = 0;  ///< of its memories, exact; a tool puts small ones into LUT RAM or flip-flops
  int bits_per_pixel = 0;      ///< of a pixel's state in the line, exact
};

/// Estimates a core's cells. The RAM and the bits are exact.
Cells estimated_cells(const Config& config);

/// How far the look-up tables and the flip-flops of estimated_cells() are off, as a share: the most over all cores that
/// were measured.
struct CellSpread {
  double luts = 0;
  double flip_flops = 0;
};
CellSpread cell_spread(const Config& config);

/// A term of a fit's sum. The core behind the front end has one fit, for colours that RESOLVE darkens. The front end,
/// and what light after light takes beyond that, have others, where there are such.
struct CellTerm {
  std::string_view name;
  double (*value)(const Config&);
};
inline constexpr std::size_t kCellTerms = 17;
inline constexpr std::size_t kFrontEndTerms = 4;
inline constexpr std::size_t kLinearTerms = 2;
extern const std::array<CellTerm, kCellTerms> kCellTermInfo;
extern const std::array<CellTerm, kFrontEndTerms> kFrontEndTermInfo;
extern const std::array<CellTerm, kLinearTerms> kLinearTermInfo;

/// The core of whose cells those of kLinearTermInfo are more: the same without light after light.
Config without_linear(Config config);

}  // namespace kage
