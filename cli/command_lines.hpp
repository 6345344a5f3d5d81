// SPDX-License-Identifier: Apache-2.0
//
// Command lines as they were given, for a person to repeat.
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "kage/cosim.hpp"

namespace kage::cli {

/// The command line that `command` was given, quoted for a shell, without the options of `leave_out`.
std::string command_line(const Command& command, const std::vector<std::string>& leave_out = {});

/// The lines of a co-simulation, of the options that `command` was given.
cosim::CommandLines command_lines(const Command& command);

}  // namespace kage::cli
