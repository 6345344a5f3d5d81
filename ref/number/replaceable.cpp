// SPDX-License-Identifier: Apache-2.0
#include "number/replaceable.hpp"

#include <fmt/format.h>

#include "kage/error.hpp"

namespace kage {

std::filesystem::path replaceable(std::filesystem::path target) {
  namespace fs = std::filesystem;
  std::error_code ec;
  if (fs::is_symlink(target, ec)) {
    fs::path real = fs::weakly_canonical(target, ec);
    if (ec) throw Error(fmt::format("{}: {}", target.string(), ec.message()));
    target = std::move(real);
  }
  const fs::file_status status = fs::status(target, ec);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw Error(fmt::format("{}: exists and is not a file", target.string()));
  return target;
}

}  // namespace kage
