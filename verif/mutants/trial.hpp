// SPDX-License-Identifier: Apache-2.0
//
// One mutant against the inputs of one configuration.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mutants/inputs.hpp"

namespace kage::verif {

/// How a mutant was found out.
struct TrialVerdict {
  std::string how;     ///< "different", "error", "hang", "assertion", "register"
  std::string module;  ///< the search for the first divergence names
  std::string text;    ///< what it says, or what the registers or the assertion say
};

/// A divergence that the search finds in the sound RTL; it would be blamed on mutants, too.
std::optional<std::string> sound_divergence(const std::filesystem::path& library, const Inputs& inputs);

/// Nothing if the mutant (0: the sound RTL) is the same as the golden core in all of them.
std::optional<TrialVerdict> try_mutant(const std::filesystem::path& library, const Inputs& inputs, int mutant);

}  // namespace kage::verif
