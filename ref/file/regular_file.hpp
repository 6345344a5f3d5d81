// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kage {

/// Throws Error unless `path` is a regular file, or a link to one: opening a pipe would wait for whoever writes to it,
/// and a device may have no end. The message begins with `name`.
void check_regular(const std::filesystem::path& path, const std::string& name);
inline void check_regular(const std::filesystem::path& path) { check_regular(path, path.string()); }

}  // namespace kage
