// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace kage::cli {

/// A script for bash that completes commands, options, their words, and names of scenes, configurations and faults.
std::string bash_completion(const CLI::App& app);

/// The same for zsh, with what each option does beside it.
std::string zsh_completion(const CLI::App& app);

}  // namespace kage::cli
