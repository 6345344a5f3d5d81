// SPDX-License-Identifier: Apache-2.0
//
// The groups in which help shows options. An option is in one group in every command that has it.
#pragma once

#include <string>
#include <vector>

namespace kage::cli {

/// The group of an option, by its first long name with dashes; that of --help for a name that has none.
std::string help_group(const std::string& option);

/// The groups in the order of the help. The last one is that of --help.
const std::vector<std::string>& help_groups();

}  // namespace kage::cli
