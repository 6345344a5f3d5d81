// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kage {

/// The extension with its dot, letters of ASCII in lower case: ".png" of "a.PNG"; empty if there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace kage
