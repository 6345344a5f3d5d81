// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace kage {

/// Directory of kage's data (it holds scenes/ and rtl/): $KAGE_DATA_DIR, else the source tree that the library was
/// built in, else share/kage under the install prefix. Throws Error if there is none.
std::filesystem::path data_directory();

}  // namespace kage
