// SPDX-License-Identifier: Apache-2.0
#include "kage/paths.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

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

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (!in) throw Error(path.string() + ": cannot be read");
  return text;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

}  // namespace kage
