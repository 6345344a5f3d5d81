// SPDX-License-Identifier: Apache-2.0
#include "file/read_file.hpp"

#include <fstream>
#include <iterator>

#include "kage/error.hpp"

namespace kage {

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (!in) throw Error(path.string() + ": cannot be read");
  return text;
}

}  // namespace kage
