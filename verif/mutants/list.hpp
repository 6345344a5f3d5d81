// SPDX-License-Identifier: Apache-2.0
//
// The mutants of mutants.yaml.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kage/config.hpp"

namespace kage::verif {

/// A deliberate defect; the numbers that RtlOptions::mutant takes are places in the list, from 1.
struct Mutant {
  int number = 0;
  std::string name;
  std::string file;  ///< from the source tree's root
  std::string kind;  ///< "flipped comparison"
  std::string breaks;
  std::string module;                ///< that must be named; "pixels": that of the arrangement
  std::vector<std::string> configs;  ///< that can tell; empty: any
  std::string equivalent;            ///< why nothing can; empty: something must
  std::string lives;                 ///< why these inputs cannot: it must live, and counts as living
  std::string named;                 ///< why another module may be named: it must be killed, and counts as named wrong

  /// The module to be named in a configuration.
  [[nodiscard]] std::string module_in(const Config& config) const {
    if (module != "pixels") return module;
    return config.arrangement == 1 ? "pixel_banked" : "pixel_systolic";
  }
};

/// Throws Error that names the file where something in it is not as it must be.
std::vector<Mutant> load_mutants(const std::filesystem::path& file);

}  // namespace kage::verif
