// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kage {

/// The whole of a file that kage made or has with it. Throws Error that names it.
std::string read_file(const std::filesystem::path& path);

}  // namespace kage
