// SPDX-License-Identifier: Apache-2.0
#include "file/real_path.hpp"

#include <algorithm>
#include <system_error>

namespace kage {

namespace fs = std::filesystem;

fs::path real_path(const fs::path& path) {
  std::error_code ec;
  const fs::path whole = fs::absolute(path, ec);
  if (ec) return {};
  fs::path real = fs::weakly_canonical(whole, ec);
  // weakly_canonical() takes a link to what does not exist for a name that does not exist.
  constexpr int kMostLinks = 40;  // as many as the kernel follows
  for (int i = 0; !ec && fs::is_symlink(real, ec); ++i) {
    if (i == kMostLinks) return {};
    real = fs::weakly_canonical(real.parent_path() / fs::read_symlink(real, ec), ec);
  }
  return ec && ec != std::errc::no_such_file_or_directory ? fs::path() : real;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return !folder.empty() && std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace kage
