// SPDX-License-Identifier: Apache-2.0
#include "file/inputs.hpp"

#include <mutex>
#include <set>
#include <system_error>

#include "file/real_path.hpp"

namespace kage {
namespace {

struct Inputs {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;  // real ones
};

Inputs& inputs() {
  static Inputs all;
  return all;
}

}  // namespace

void keep_input(const std::filesystem::path& path) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(path, ec)) return;
  const std::lock_guard lock(inputs().mutex);
  inputs().paths.insert(real_path(path));
}

bool is_input(const std::filesystem::path& path) {
  const std::lock_guard lock(inputs().mutex);
  return !inputs().paths.empty() && inputs().paths.count(real_path(path)) != 0;
}

}  // namespace kage
