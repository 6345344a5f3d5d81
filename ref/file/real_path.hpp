// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace kage {

/// The one path that all names of a file lead to: from the root, without links and dots. A file that does not exist yet
/// gets the path that it would have, and a link to it leads there. Empty if there can be no such file (links that go
/// round, a folder that may not be read).
std::filesystem::path real_path(const std::filesystem::path& path);

/// Whether `path` is `folder` or lies in it. Both are real paths; nothing lies in an empty one.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace kage
