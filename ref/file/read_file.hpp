// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kage {

/// The whole of a file. Throws Error that names it, as `name` where that is given, and the cause.
std::string read_file(const std::filesystem::path& path, const std::string& name = {});

}  // namespace kage
