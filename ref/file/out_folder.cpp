// SPDX-License-Identifier: Apache-2.0
#include "file/out_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "kage/error.hpp"

namespace kage {

OutFolder::OutFolder(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code ec;
  std::vector<fs::path> missing;
  for (fs::path p = path; !p.empty() && !fs::exists(p, ec); p = p.parent_path()) {
    if (fs::is_symlink(p, ec)) throw Error(fmt::format("{}: a link to nowhere", p.string()));
    missing.insert(missing.begin(), p);
  }
  // One by one, so that a failure half-way leaves none: the destructor of a half-made object does not run.
  for (const fs::path& p : missing) {
    if (fs::create_directory(p, ec)) made_.insert(made_.begin(), p);
    if (ec) break;
  }
  if (ec || !fs::is_directory(path, ec)) {
    remove();
    throw Error(fmt::format("{}: the folder cannot be made: {}", path.string(), ec ? ec.message() : "not a folder"));
  }
  if (::access(path.c_str(), W_OK | X_OK) != 0) {
    const int error = errno;
    remove();
    throw Error(fmt::format("{}: cannot be written to: {}", path.string(), std::strerror(error)));
  }
}

OutFolder::~OutFolder() { remove(); }

void OutFolder::remove() {
  for (const std::filesystem::path& p : made_) (void)::rmdir(p.c_str());  // refuses one with something in it
  made_.clear();
}

}  // namespace kage
