// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kage/defs.hpp"

namespace kage::cosim {

/// An RTL model: a shared library that Verilator and the C++ compiler made of rtl/ for one configuration.
struct Model {
  std::filesystem::path library;
  double build_seconds = 0;  ///< 0: it was there
  std::string damage = {};   ///< what was wrong with the one that was there, and had to be built anew; empty: nothing
};

/// Called while a model is being built, several times a second, with the seconds so far; may throw, which ends the
/// build.
using BuildProgress = std::function<void(double seconds)>;

struct ModelOptions {
  std::string fault = {};  ///< a name of faults(); empty for none
  bool monitors = false;   ///< with those of verif/cosim/diverge/monitors (slower)
  bool waves = false;      ///< able to write waveforms (slower)
  bool lines = false;      ///< counts how often each line and branch of the RTL runs (slower)
  bool mutants = false;    ///< with all mutants of verif/mutants, behind RtlOptions::mutant (slower)
  std::string ports = {};  ///< a module whose ports it writes as text at every clock (driver/ports.py); empty for none
  std::string netlist = {};  ///< a family of FPGAs, ice40 or ecp5: of the cells that yosys makes of the RTL for it
                             ///< (driver/netlist.py); empty for the RTL itself
  BuildProgress progress = {};
};

/// The model of `config` from the cache (cosim/model/model_cache.hpp), built first if it is not there or damaged. Its
/// key is the SHA-256 of all its sources, the parameters, the options, $CXX, and the versions of Verilator, compiler
/// and, for a netlist, yosys. So a changed source is another model. Two programs that want the same one build it once.
/// Throws Error that names the log when the build fails.
Model find_model(const Config& config, const ModelOptions& options = {});

/// Whether find_model() would find it in the cache.
bool has_model(const Config& config, const ModelOptions& options = {});

/// A deliberate defect of the core, of verif/cosim/model/faults.yaml.
struct Fault {
  std::string name;
  std::string breaks;  ///< what it does, a sentence
};

/// The faults that ModelOptions::fault takes, sorted by name. Throws Error that names the list where it cannot be read.
std::vector<Fault> faults();

/// Names and versions of the tools that make models, a line each: "Verilator 5.006 2023-01-22 rev ...", "c++
/// (Debian 12.2.0-14) 12.2.0".
std::vector<std::string> model_tools();

}  // namespace kage::cosim
