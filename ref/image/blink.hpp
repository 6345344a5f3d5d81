// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "file/temp_file.hpp"
#include "kage/diff.hpp"

namespace kage {

/// As save_blink() of kage/diff.hpp, but the picture gets its name with the others of `files`.
void save_blink(TempFiles& files, const std::filesystem::path& path, const Image& a, const Image& b);

}  // namespace kage
