// SPDX-License-Identifier: Apache-2.0
#include "file/read_file.hpp"

#include <algorithm>

#include "file/plain_io.hpp"

namespace kage {

std::string read_file(const std::filesystem::path& path, const std::string& name) {
  const ReadOnly in(path, name);
  std::string text;
  std::size_t size = 0;
  for (std::size_t step = std::size_t{1} << 14;; step = std::min(2 * step, std::size_t{1} << 24)) {
    text.resize(size + step);
    const std::size_t n = in.read(text.data() + size, step);
    size += n;
    if (n == 0) break;
  }
  text.resize(size);
  return text;
}

}  // namespace kage
