// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace kage {

/// Directory of kage's data (it holds scenes/ and rtl/): $KAGE_DATA_DIR, else the source tree that the library was
/// built in, else share/kage under the install prefix. Throws Error if there is none.
std::filesystem::path data_directory();

/// The whole of a file that kage made or has with it. Throws Error that names it.
std::string read_file(const std::filesystem::path& path);

/// The extension with its dot, letters of ASCII in lower case: ".png" of "a.PNG"; empty if there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace kage
