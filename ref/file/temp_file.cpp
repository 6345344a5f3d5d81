// SPDX-License-Identifier: Apache-2.0
#include "file/temp_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>

#include "file/inputs.hpp"
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
  fs::path real = real_path(target);
  if (real.empty()) throw Error(fmt::format("{}: cannot be written: a link that leads nowhere", target.string()));
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

/// The file that has the name itself; none if nothing has.
std::optional<FileId> id_of(const fs::path& path) {
  struct stat st {};
  if (lstat(path.c_str(), &st) != 0) return std::nullopt;
  return FileId{st.st_dev, st.st_ino, st.st_mode, st.st_size, st.st_mtim.tv_sec, st.st_mtim.tv_nsec};
}

void refuse_input(const fs::path& target, const fs::path& given) {
  if (is_input(target)) throw Error(fmt::format("{}: this output would overwrite an input", given.string()));
}

}  // namespace

bool is_device(const fs::path& path) {
  std::error_code ec;
  const fs::file_status status = fs::status(path, ec);
  return fs::is_fifo(status) || fs::is_character_file(status);
}

TempFile::TempFile(fs::path target, Way way)
    : given_(std::move(target)), name_(whole_name(given_)), target_(given_), way_(way) {
  refuse_input(target_, given_);
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
  refuse_input(target_, given_);
  if (way_ == Way::remove) {
    move_aside(false);
  } else if (device_) {
    write_device();
  } else {
    rename();
  }
  placed_ = true;
}

void TempFile::rename() {
  std::error_code ec;
  if (fs::exists(fs::symlink_status(target_, ec))) move_aside(true);
  own_ = id_of(temp_);
  fs::rename(temp_, target_, ec);
  if (ec) {
    undo();
    fail_write(given_.string(), ec.value());
  }
  temp_.clear();
}

// The name may have come to be something else since it was asked for: that is not kage's, and stays. It is looked at
// again under the name that nobody else has, because the first look may be too early.
void TempFile::move_aside(bool link) {
  const auto refuse = [&] { throw Error(fmt::format("{}: exists and is not a file", given_.string())); };
  std::error_code ec;
  if (const auto status = fs::symlink_status(target_, ec); fs::exists(status) && !fs::is_regular_file(status)) refuse();
  const fs::path kept = folder_->new_name(target_.extension());
  // A second name, so that the first one is never without a file; where there are none, it has to be for a moment.
  ec = std::make_error_code(std::errc::operation_not_permitted);
  if (link) fs::create_hard_link(target_, kept, ec);
  const bool moved = static_cast<bool>(ec);
  if (moved) fs::rename(target_, kept, ec);
  if (ec && way_ == Way::remove) throw Error(fmt::format("{}: cannot be removed: {}", given_.string(), ec.message()));
  if (ec) fail_write(given_.string(), ec.value());
  if (fs::is_regular_file(fs::symlink_status(kept, ec))) {
    aside_ = kept;
    return;
  }
  if (moved)
    (void)renameat2(AT_FDCWD, kept.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE);
  else
    fs::remove(kept, ec);
  refuse();
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
  const bool there = fs::exists(fs::symlink_status(target_, ec));
  if (!device_ && there && (!own_ || id_of(target_) != own_)) {
    // Another program has given the name to a file of its own meanwhile.
    if (!aside_.empty()) fs::remove(aside_, ec);
  } else if (aside_.empty()) {
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
