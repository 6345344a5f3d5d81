// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "kage/error.hpp"

namespace kage::cosim {

/// A lock on a file or folder that other programs see, released with the object. Who has a lock's file removed has the
/// lock: another, who has opened the file before and takes its lock later, has one that nobody else sees, and opens the
/// new file.
class Lock {
 public:
  /// Makes the file if it is not there, unless `flags` say otherwise. Throws Error if it cannot be opened.
  explicit Lock(const std::filesystem::path& path, int flags = O_RDWR | O_CREAT)
      : path_(path), flags_(flags), fd_(opened()) {}
  ~Lock() { close(fd_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  /// Throws Error if the file is gone and cannot be made anew.
  [[nodiscard]] bool try_lock() {
    if (flock(fd_, LOCK_EX | LOCK_NB) != 0) return false;
    if (is_named()) return true;
    close(std::exchange(fd_, -1));
    fd_ = opened();
    return flock(fd_, LOCK_EX | LOCK_NB) == 0 && is_named();
  }

 private:
  [[nodiscard]] int opened() const {
    const int fd = open(path_.c_str(), flags_ | O_CLOEXEC, 0600);
    if (fd < 0) throw Error(fmt::format("{}: cannot be opened: {}", path_.string(), std::strerror(errno)));
    return fd;
  }
  /// Whether the file that is locked is the one that has the name.
  [[nodiscard]] bool is_named() const {
    struct stat own {};
    struct stat now {};
    return fstat(fd_, &own) == 0 && stat(path_.c_str(), &now) == 0 && own.st_dev == now.st_dev &&
           own.st_ino == now.st_ino;
  }

  std::filesystem::path path_;
  int flags_;
  int fd_;
};

}  // namespace kage::cosim
