// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "kage/error.hpp"

namespace kage::cosim {

/// A descriptor, closed with the object.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

/// Hands all that can be read from `fd` to `take(data, bytes)`, piece by piece. Throws Error that names `path`.
template <typename Take>
void read_all(int fd, const std::filesystem::path& path, Take take) {
  std::array<unsigned char, 65536> buffer{};
  while (true) {
    const ssize_t n = read(fd, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    if (n == 0) return;
    take(buffer.data(), static_cast<std::size_t>(n));
  }
}

/// The file's content.
inline std::string text_of(int fd, const std::filesystem::path& path) {
  std::string text;
  read_all(fd, path,
           [&](const unsigned char* data, std::size_t n) { text.append(reinterpret_cast<const char*>(data), n); });
  return text;
}

}  // namespace kage::cosim
