// SPDX-License-Identifier: Apache-2.0
//
// The cells that yosys makes of a core. A run takes ten seconds to some minutes, so its counts are kept.
#pragma once

#include <functional>
#include <string>

#include "kage/config.hpp"

namespace kage::explore {

/// Cells of one core, as synthesis counts them before placement.
struct CellCount {
  int luts = 0;        ///< ECP5: LUT4, two for each CCU2C of a carry chain, four for each TRELLIS_DPR16X4 of LUT RAM
  int flip_flops = 0;  ///< TRELLIS_FF
  int rams = 0;        ///< DP16KD, 18 kbit each
  int dsps = 0;        ///< MULT18X18D
};

struct Synthesis {
  CellCount cells;
  std::string yosys;   ///< as `yosys -V` says it
  double seconds = 0;  ///< that it took; 0: the counts were kept
};

/// Counts the cells of a core on an ECP5 by `yosys` of PATH, or of $YOSYS. Counts are kept in
/// ${XDG_CACHE_HOME:-~/.cache}/kage/cells, keyed by the RTL's files, the parameters and the version of yosys; `anew`
/// passes over what is kept. `wait` is called several times a second; what it throws ends yosys and goes through.
/// Throws Error if there is no yosys, or if it fails: then the message has its last line.
Synthesis synthesize(const Config& config, const std::function<void()>& wait, bool anew = false);

/// Output of `yosys -V`. Throws Error if there is no yosys.
std::string yosys_version(const std::function<void()>& wait);

/// The counts of the same, if they are kept.
bool is_synthesized(const Config& config);

}  // namespace kage::explore
