// SPDX-License-Identifier: Apache-2.0
#include "image/temp_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
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

}  // namespace kage
