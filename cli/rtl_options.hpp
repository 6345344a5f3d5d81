// SPDX-License-Identifier: Apache-2.0
//
// Options of the commands that run the RTL.
#pragma once

#include <array>
#include <string>

#include "arguments.hpp"
#include "kage/cosim.hpp"

namespace kage::cli {

/// The options of option_rtl().
inline constexpr std::array kRtlOptions{"--fault", "--mutant", "--netlist", "--idle", "--backpressure"};

/// --idle, --backpressure, --netlist, and those of option_defect().
void option_rtl(Command command, cosim::RtlRun& rtl);

/// --netlist: the RTL as an FPGA's cells.
void option_netlist(Command command, std::string& netlist);

/// RTL that is wrong on purpose: --fault, and --mutant, which no help shows (docs/mutants.md).
void option_defect(Command command, cosim::RtlRun& rtl);

/// Throws Error if one of these is given, of a command that runs no RTL this time.
void refuse_rtl(const cosim::RtlRun& rtl, const std::string& why);

}  // namespace kage::cli
