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

namespace {

namespace fs = std::filesystem;

/// A name beside `target` that nothing has.
fs::path name_beside(const fs::path& target) {
  static std::atomic<unsigned> count{0};
  fs::path name = target;
  name.replace_filename(
      fmt::format(".{}.{}.{}{}", target.stem().string(), getpid(), count++, target.extension().string()));
  return name;
}

}  // namespace

TempFile::TempFile(fs::path target, Way way) : target_(std::move(target)), way_(way) {
  if (way == Way::remove) return;
  target_ = replaceable(std::move(target_));
  temp_ = name_beside(target_);
}

TempFile::~TempFile() {
  std::error_code ec;
  if (placed_) undo();
  if (!temp_.empty()) fs::remove(temp_, ec);
}

void TempFile::place() {
  std::error_code ec;
  const fs::path kept = name_beside(target_);
  if (way_ == Way::remove) {
    fs::rename(target_, kept, ec);
    if (ec) throw Error(fmt::format("{}: cannot be removed: {}", target_.string(), ec.message()));
    aside_ = kept;
  } else {
    const bool there = fs::exists(fs::symlink_status(target_, ec));
    if (there) {
      // A second name, so that the first one is never without a file; where there are none, it has to be for a moment.
      fs::create_hard_link(target_, kept, ec);
      if (ec) fs::rename(target_, kept, ec);
      if (!ec) aside_ = kept;
    }
    if (!there || !aside_.empty()) fs::rename(temp_, target_, ec);
    if (ec) {
      const std::string cause = ec.message();
      if (!aside_.empty()) undo();
      throw Error(fmt::format("{}: cannot be written: {}", target_.string(), cause));
    }
    temp_.clear();
  }
  placed_ = true;
}

void TempFile::undo() {
  std::error_code ec;
  if (aside_.empty()) {
    fs::remove(target_, ec);
  } else {
    fs::rename(aside_, target_, ec);
    if (!ec) fs::remove(aside_, ec);  // rename() leaves both where they are two names of one file
  }
  aside_.clear();
  placed_ = false;
}

void TempFile::settle() {
  std::error_code ec;
  if (!aside_.empty()) fs::remove(aside_, ec);
  aside_.clear();
  placed_ = false;
}

void TempFiles::place() {
  try {
    for (const auto& file : files_) file->place();
  } catch (...) {
    drop();
    throw;
  }
}

void TempFiles::settle() {
  for (const auto& file : files_) file->settle();
  files_.clear();
}

void TempFiles::drop() {
  while (!files_.empty()) files_.pop_back();
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
