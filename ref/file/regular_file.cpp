// SPDX-License-Identifier: Apache-2.0
#include "file/regular_file.hpp"

#include "kage/error.hpp"

namespace kage {

void check_regular(const std::filesystem::path& path, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw Error(name + ": no such file");
  if (error) throw Error(name + ": " + error.message());
  if (fs::is_directory(status)) throw Error(name + ": is a directory");
  if (!fs::is_regular_file(status)) throw Error(name + ": is not a regular file");
}

}  // namespace kage
