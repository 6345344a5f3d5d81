// SPDX-License-Identifier: Apache-2.0
#include "file/inputs.hpp"

#include <fmt/format.h>

#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "file/real_path.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

struct Inputs {
  std::mutex mutex;
  std::set<std::filesystem::path> paths;        // real ones
  std::vector<std::filesystem::path> expected;  // outputs, as they were named
};

Inputs& inputs() {
  static Inputs all;
  return all;
}

}  // namespace

void keep_input(const std::filesystem::path& path) {
  std::error_code ec;
  if (!std::filesystem::is_regular_file(path, ec)) return;
  const std::filesystem::path real = real_path(path);
  const std::lock_guard lock(inputs().mutex);
  inputs().paths.insert(real);
  for (const std::filesystem::path& output : inputs().expected)
    if (real_path(output) == real)
      throw Error(fmt::format("{}: this output would overwrite an input", output.string()));
}

void expect_output(const std::filesystem::path& path) {
  const std::lock_guard lock(inputs().mutex);
  inputs().expected.push_back(path);
}

bool is_input(const std::filesystem::path& path) {
  const std::lock_guard lock(inputs().mutex);
  return !inputs().paths.empty() && inputs().paths.count(real_path(path)) != 0;
}

}  // namespace kage
