// SPDX-License-Identifier: Apache-2.0
//
// What an RTL model is made of: files and tools. All of it is in the model's key.
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
};

/// Each is empty if the tool cannot be run.
std::string verilator_version();
std::string compiler_version();

/// Throws Error if there is no Verilator.
ModelTools model_tool_versions(const ModelOptions& options);

/// The files that the model is made of, sorted, below `data`: all that build.py reads.
/// Throws Error if folders are missing or there is no such fault.
std::vector<std::filesystem::path> model_sources(const std::filesystem::path& data, const ModelOptions& options);

/// The key of the model in the cache: see find_model().
std::string model_key(const std::filesystem::path& data, const std::vector<std::filesystem::path>& files,
                      const Config& config, const ModelOptions& options, const ModelTools& tools);

}  // namespace kage::cosim
