// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "kage/error.hpp"

namespace kage::cosim {

/// A lock on a file or folder that other programs see, released with the object.
class Lock {
 public:
  /// Makes the file if it is not there, unless `flags` say otherwise. Throws Error if it cannot be opened.
  explicit Lock(const std::filesystem::path& path, int flags = O_RDWR | O_CREAT)
      : fd_(open(path.c_str(), flags | O_CLOEXEC, 0600)) {
    if (fd_ < 0) throw Error(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  }
  ~Lock() { close(fd_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

  [[nodiscard]] bool try_lock() const { return flock(fd_, LOCK_EX | LOCK_NB) == 0; }

 private:
  int fd_;
};

}  // namespace kage::cosim
