// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "arguments.hpp"

namespace kage::cli {

/// A script for bash that completes commands, options, their words, and names of scenes, configurations and faults.
std::string bash_completion(const Program& program);

/// The same for zsh, with what each option does beside it.
std::string zsh_completion(const Program& program);

}  // namespace kage::cli
