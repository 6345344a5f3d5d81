// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "image/temp_file.hpp"
#include "kage/image.hpp"

namespace kage {

/// As save_image() of kage/image.hpp, but the picture gets its name with the others of `files`.
void save_image(TempFiles& files, const std::filesystem::path& path, const Image& image);

}  // namespace kage
