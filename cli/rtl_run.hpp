// SPDX-License-Identifier: Apache-2.0
//
// What the commands that run the RTL share: how it is run, and its models, which are built where they are not there.
#pragma once

#include <array>
#include <string>

#include "cosim/diverge/divergence.hpp"
#include "cosim/model/model.hpp"
#include "cosim/model/rtl_identity.hpp"
#include "kage/config.hpp"
#include "options.hpp"

namespace kage::cli {

/// How a command runs the RTL.
struct RtlRun {
  std::string fault;
  std::string ports = {};     // cosim::ModelOptions::ports
  std::string netlist = {};   // cosim::ModelOptions::netlist
  cosim::RtlOptions options;  // with a mutant the model is one that has them all
};

/// The options of option_rtl().
inline constexpr std::array kRtlOptions{"--fault", "--mutant", "--netlist", "--idle", "--backpressure"};

/// --idle, --backpressure, --netlist, and those of option_defect().
void option_rtl(CLI::App& command, RtlRun& rtl);

/// --netlist: the RTL as an FPGA's cells.
void option_netlist(CLI::App& command, std::string& netlist);

/// RTL that is wrong on purpose: --fault, and --mutant, which no help shows (docs/mutants.md).
void option_defect(CLI::App& command, RtlRun& rtl);

/// Throws Error if one of these is given, of a command that runs no RTL this time.
void refuse_rtl(const RtlRun& rtl, const std::string& why);

/// What a model is for besides pixels.
enum class ModelFor { kPixels, kMonitors, kWaveforms, kLines };

/// The model of a configuration; says how long it takes where it has to be built. Notes on standard error, once in a
/// run, if the current folder is of a tree with another rtl/ than the model's.
cosim::Model model_of(const NamedConfig& config, const RtlRun& rtl, ModelFor what = ModelFor::kPixels);

/// The identity of that model's RTL, for kept verdicts. Prints the same note as model_of().
cosim::RtlIdentity identity_of(const NamedConfig& config);

/// Where the RTL is that models are built of.
std::string rtl_directory();

/// To run it again by such a model. Assertions are not looked at: what differs comes before what they say of it.
cosim::ReplayOptions replay(const NamedConfig& config, const RtlRun& rtl, ModelFor what);

}  // namespace kage::cli
