// SPDX-License-Identifier: Apache-2.0
#include "file/temp_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>

#include "file/plain_io.hpp"
#include "file/real_path.hpp"
#include "kage/error.hpp"

namespace kage {
namespace {

namespace fs = std::filesystem;

/// The file that writing to `target` is to replace: `target` itself, or what it links to.
fs::path replaced_by(const fs::path& target) {
  std::error_code ec;
  if (!fs::is_symlink(target, ec)) return target;
  fs::path real = fs::weakly_canonical(target, ec);
  if (ec) throw Error(fmt::format("{}: {}", target.string(), ec.message()));
  return real;
}

/// The same for a name from here and one from the root.
fs::path whole_name(const fs::path& path) {
  std::error_code ec;
  return fs::absolute(path, ec).lexically_normal();
}

std::shared_ptr<HiddenFolder> hidden_beside(const fs::path& target, const fs::path& given) {
  const fs::path folder = target.parent_path();
  std::error_code ec;
  if (!folder.empty() && !fs::is_directory(folder, ec))
    throw Error(fmt::format("{}: cannot be written: no such folder", given.string()));
  try {
    return HiddenFolder::in(folder);
  } catch (const std::system_error& e) {
    fail_write(given.string(), e.code().value());
  }
}

}  // namespace

bool is_device(const fs::path& path) {
  std::error_code ec;
  const fs::file_status status = fs::status(path, ec);
  return fs::is_fifo(status) || fs::is_character_file(status);
}

TempFile::TempFile(fs::path target, Way way)
    : given_(std::move(target)), name_(whole_name(given_)), target_(given_), way_(way) {
  if (way == Way::remove) {
    folder_ = hidden_beside(target_, given_);
    return;
  }
  device_ = kage::is_device(target_);
  std::error_code ec;
  if (device_) {
    if (access(target_.c_str(), W_OK) != 0) fail_write(given_.string(), errno);
    folder_ = hidden_beside(fs::temp_directory_path(ec) / "any", given_);
  } else {
    target_ = replaced_by(target_);
    const fs::file_status status = fs::status(target_, ec);
    if (fs::exists(status) && !fs::is_regular_file(status))
      throw Error(fmt::format("{}: exists and is not a file", given_.string()));
    folder_ = hidden_beside(target_, given_);
  }
  temp_ = folder_->new_name(target_.extension());
}

TempFile::~TempFile() {
  std::error_code ec;
  if (placed_) undo();
  if (!temp_.empty()) fs::remove(temp_, ec);
}

fs::path TempFile::target() const { return real_path(target_); }

void TempFile::place() {
  if (way_ == Way::remove) {
    std::error_code ec;
    const fs::path kept = folder_->new_name(target_.extension());
    fs::rename(target_, kept, ec);
    if (ec) throw Error(fmt::format("{}: cannot be removed: {}", given_.string(), ec.message()));
    aside_ = kept;
  } else if (device_) {
    write_device();
  } else {
    rename();
  }
  placed_ = true;
}

void TempFile::rename() {
  std::error_code ec;
  const bool there = fs::exists(fs::symlink_status(target_, ec));
  if (there) {
    // A second name, so that the first one is never without a file; where there are none, it has to be for a moment.
    const fs::path kept = folder_->new_name(target_.extension());
    fs::create_hard_link(target_, kept, ec);
    if (ec) fs::rename(target_, kept, ec);
    if (!ec) aside_ = kept;
  }
  if (!there || !aside_.empty()) fs::rename(temp_, target_, ec);
  if (ec) {
    if (!aside_.empty()) undo();
    fail_write(given_.string(), ec.value());
  }
  temp_.clear();
}

void TempFile::write_device() {
  const int fd = open(target_.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (fd < 0) fail_write(given_.string(), errno);
  try {
    const ReadOnly from(temp_);
    std::string piece(1 << 16, '\0');
    while (const std::size_t n = from.read(piece.data(), piece.size())) write_all(fd, piece.data(), n, given_.string());
  } catch (...) {
    (void)close(fd);
    throw;
  }
  if (close(fd) != 0 && errno != EINTR) fail_write(given_.string(), errno);
}

void TempFile::undo() {
  std::error_code ec;
  if (aside_.empty()) {
    if (!device_) fs::remove(target_, ec);
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

void TempFiles::take(TempFiles& others) {
  for (auto& file : others.files_) files_.push_back(std::move(file));
  others.files_.clear();
}

fs::path TempFiles::now(const fs::path& target) const {
  const fs::path name = whole_name(target);
  const auto found = std::find_if(files_.rbegin(), files_.rend(), [&](const auto& file) {
    return !file->temp().empty() && file->name().native() == name.native();
  });
  return found == files_.rend() ? target : (*found)->temp();
}

void TempFiles::place() {
  std::set<fs::path> names;
  for (const auto& file : files_)
    if (!file->temp().empty() && !file->is_device() && !names.insert(file->target()).second)
      throw Error(fmt::format("{}: two outputs have this name", file->given().string()));
  try {
    for (const bool devices : {false, true})
      for (const auto& file : files_)
        if (file->is_device() == devices) file->place();
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

void write_text(TempFiles& files, const std::string& path, const std::string& text) {
  OutputFile out(files, path);
  out << text;
  out.close();
}

}  // namespace kage
