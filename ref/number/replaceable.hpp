// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace kage {

/// The file that writing to `target` is to replace: `target` itself, or what it links to. Throws Error if that exists
/// and is no regular file: renaming over a device or a folder would destroy it.
std::filesystem::path replaceable(std::filesystem::path target);

}  // namespace kage
