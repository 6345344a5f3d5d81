// SPDX-License-Identifier: Apache-2.0
//
// Cases that failed once, as text files: a line "family NAME", then the case's fields, with what was wrong in comments.
#pragma once

#include <filesystem>
#include <string>

#include "extremes/family.hpp"

namespace kage::verif {

/// Writes FOLDER/FAMILY-HASH.txt, whole or not at all, and returns its path. `wrong` and `case_name` become comments.
std::filesystem::path write_found(const std::filesystem::path& folder, const Family& family, const std::string& text,
                                  const std::string& wrong, const std::string& case_name);

struct FoundCase {
  const Family* family = nullptr;
  std::string text;  ///< of the case; lines are those of the file
};

/// Throws Error that names the file and a line where it is none.
FoundCase read_found(const std::filesystem::path& file);

/// All such files of a folder, in order of their names. Throws Error where the folder cannot be read.
std::vector<std::filesystem::path> found_files(const std::filesystem::path& folder);

}  // namespace kage::verif
