// SPDX-License-Identifier: Apache-2.0
//
// Where what a tool found of a core is kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kage/config.hpp"

namespace kage::trade {

/// The files of a folder of kage's data that have the extension, sorted. Throws Error if the folder is not there.
std::vector<std::filesystem::path> data_files(const char* folder, const char* extension);

/// A file of the folder `cache` of kage's cache, called by all that decides what is found of the core: the RTL's files,
/// the parameters, and `besides`: tools, their versions and what they are asked.
std::filesystem::path kept_core_file(const char* cache, const Config& config, const std::vector<std::string>& besides);

}  // namespace kage::trade
