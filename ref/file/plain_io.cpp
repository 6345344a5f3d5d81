// SPDX-License-Identifier: Apache-2.0
#include "file/plain_io.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

#include "kage/error.hpp"

namespace kage {

void fail_write(const std::string& name, int error) {
  throw Error(fmt::format("{}: cannot be written: {}", name, std::strerror(error)));
}

void write_all(int fd, const char* data, std::size_t size, const std::string& name) {
  struct stat st {};
  const bool regular = fstat(fd, &st) == 0 && S_ISREG(st.st_mode);
  while (size != 0) {
    // A pipe that is ready takes so many bytes without waiting, so that all waiting is in poll(), which a signal ends.
    const std::size_t piece = regular ? size : std::min<std::size_t>(size, PIPE_BUF);
    pollfd ready{fd, POLLOUT, 0};
    if (!regular && poll(&ready, 1, -1) < 0) fail_write(name, errno);
    const ssize_t n = ::write(fd, data, piece);
    if (n < 0 && errno == EINTR && regular) continue;
    if (n <= 0) fail_write(name, n == 0 ? ENOSPC : errno);
    data += n;
    size -= static_cast<std::size_t>(n);
  }
}

void sync_file(const std::filesystem::path& path, const std::string& name) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const int error = fd < 0 || fsync(fd) != 0 ? errno : 0;
  if (fd >= 0) (void)close(fd);
  if (error != 0) fail_write(name, error);
}

ReadOnly::ReadOnly(const std::filesystem::path& file, const std::string& name)
    : name_(name.empty() ? file.string() : name), fd_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (fd_ < 0) throw Error(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
}

ReadOnly::~ReadOnly() { (void)close(fd_); }

std::size_t ReadOnly::read(char* data, std::size_t size) const {
  for (;;) {
    const ssize_t n = ::read(fd_, data, size);
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EINTR) throw Error(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
  }
}

int unnamed_file() {
  const char* const variable = std::getenv("TMPDIR");
  const std::string folder = variable != nullptr && *variable != '\0' ? variable : "/tmp";
  const int fd = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  // EISDIR is what a kernel says that does not know the flag.
  if (fd >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return fd;
  std::string name = folder + "/kage-XXXXXX";
  const int named = mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) (void)unlink(name.c_str());
  return named;
}

}  // namespace kage
