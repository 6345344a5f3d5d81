// SPDX-License-Identifier: Apache-2.0
//
// Where what a tool found of a core is kept.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "json/foreign_json.hpp"
#include "kage/config.hpp"
#include "kage/error.hpp"

namespace kage::explore {

/// The files of a folder of kage's data that have the extension, sorted. Throws Error if the folder is not there.
std::vector<std::filesystem::path> data_files(const char* folder, const char* extension);

/// A file of the folder `cache` of kage's cache, called by all that decides what is found of the core: the RTL's files,
/// the parameters, and `besides`: tools, their versions and what they are asked.
std::filesystem::path kept_core_file(const char* cache, const Config& config, const std::vector<std::string>& besides);

/// Keeps in such a file what was found.
void keep_core(const std::filesystem::path& path, const nlohmann::ordered_json& found);

/// Content of such a file, as `read` makes it of the JSON. None: it is not there, or damaged, and is to be found again.
template <class Read>
std::optional<std::invoke_result_t<Read, const nlohmann::ordered_json&>> kept_core(const std::filesystem::path& path,
                                                                                   Read read) {
  try {
    return read(read_json(path));
  } catch (const Error&) {
    return std::nullopt;
  } catch (const nlohmann::ordered_json::exception&) {
    return std::nullopt;
  }
}

}  // namespace kage::explore
