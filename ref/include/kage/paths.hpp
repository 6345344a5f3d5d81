// SPDX-License-Identifier: Apache-2.0

/// @file
/// Where kage's data is.
#pragma once

#include <filesystem>

namespace kage {

/// Finds the folder of kage's data, which holds scenes/ and rtl/. Throws Error if there is none.
/// @return $KAGE_DATA_DIR, else the source tree that the library was built in, else share/kage under the install prefix
std::filesystem::path data_directory();

}  // namespace kage
