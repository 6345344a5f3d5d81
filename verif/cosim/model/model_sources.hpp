// SPDX-License-Identifier: Apache-2.0
//
// Files and tools that an RTL model is made of. All of them are in the model's key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cosim/model/model.hpp"

namespace kage::cosim {

/// The tools that verif/cosim/model/driver/build.py takes.
struct ModelTools {
  std::string verilator;  ///< what `verilator --version` prints
  std::string cxx;        ///< $CXX, which may have flags
  std::string compiler;   ///< what it prints for --version
  std::string yosys;      ///< what `yosys -V` prints, of a netlist; empty for the RTL
};

/// Each is empty if the tool is not there or says no version. Throws NotStarted if it cannot be started for another
/// reason. A program asks a tool once: `verilator --version` starts Perl, which takes longer than a small frame.
const std::string& verilator_version(const BuildProgress& progress = {});
const std::string& compiler_version(const BuildProgress& progress = {});

/// Throws Error if there is no Verilator, or, for a netlist, no yosys. With `anew` the tools are asked now, as they may
/// be others since this program asked first.
ModelTools model_tool_versions(const ModelOptions& options, bool anew = false);

/// The files that a model is made of: all that build.py reads, by verif/cosim/model/driver/sources.yaml. Paths are
/// below the source tree, and sorted.
struct ModelSources {
  std::vector<std::filesystem::path> files;     ///< all
  std::vector<std::filesystem::path> modules;   ///< of these, what Verilator is given
  std::vector<std::filesystem::path> headers;   ///< of these, what the modules include
  std::vector<std::filesystem::path> includes;  ///< the folders that it looks for headers in
  std::vector<std::string> flags;               ///< what Verilator's own options decide about reading them
};

/// Throws Error if folders are missing or there is no such fault.
ModelSources model_sources(const std::filesystem::path& data, const ModelOptions& options);

/// The key of the model in the cache: see find_model(). `data` is the tree whose files are read.
std::string model_key(const std::filesystem::path& data, const ModelSources& sources, const Config& config,
                      const ModelOptions& options, const ModelTools& tools);

}  // namespace kage::cosim
