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
  return ec ? fs::path() : real;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return !folder.empty() && std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

}  // namespace kage
