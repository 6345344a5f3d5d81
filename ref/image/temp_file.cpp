// SPDX-License-Identifier: Apache-2.0
#include "image/temp_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "kage/error.hpp"
#include "number/replaceable.hpp"

namespace kage {

TempFile::TempFile(std::filesystem::path target) : target_(replaceable(std::move(target))) {
  static std::atomic<unsigned> count{0};
  temp_ = target_;
  temp_.replace_filename(
      fmt::format(".{}.{}.{}{}", target_.stem().string(), getpid(), count++, target_.extension().string()));
}

TempFile::~TempFile() {
  std::error_code ec;
  if (!temp_.empty()) std::filesystem::remove(temp_, ec);
}

void TempFile::commit() {
  std::error_code ec;
  std::filesystem::rename(temp_, target_, ec);
  if (ec) throw Error(fmt::format("{}: cannot be written: {}", target_.string(), ec.message()));
  temp_.clear();
}

std::ofstream open_file(TempFiles& files, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code ec;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ec))
    throw Error(fmt::format("{}: cannot be written: no such folder", path));
  errno = 0;
  std::ofstream out(files.add(path), std::ios::binary);
  if (!out) throw Error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
  return out;
}

void write_text(TempFiles& files, const std::string& path, const std::string& text) {
  std::ofstream out = open_file(files, path);
  errno = 0;
  out << text;
  out.close();
  if (!out) throw Error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

}  // namespace kage
