// SPDX-License-Identifier: Apache-2.0
#include "kage/paths.hpp"

#include <cstdlib>

#include "kage/error.hpp"

// Both are set by CMake.
#ifndef KAGE_SOURCE_DATA_DIR
#define KAGE_SOURCE_DATA_DIR ""
#endif
#ifndef KAGE_INSTALL_DATA_DIR
#define KAGE_INSTALL_DATA_DIR ""
#endif

namespace kage {

std::filesystem::path data_directory() {
  namespace fs = std::filesystem;
  if (const char* env = std::getenv("KAGE_DATA_DIR"); env != nullptr && *env != '\0') return env;
  for (const char* candidate : {KAGE_SOURCE_DATA_DIR, KAGE_INSTALL_DATA_DIR})
    if (*candidate != '\0' && fs::exists(fs::path(candidate) / "rtl/defs/configs.yaml")) return candidate;
  throw Error("kage's data (rtl/, scenes/) is not where it was built or installed: set KAGE_DATA_DIR");
}

}  // namespace kage
