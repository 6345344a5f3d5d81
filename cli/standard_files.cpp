// SPDX-License-Identifier: Apache-2.0
#include "standard_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace kage::cli {

void open_standard_files() {
  // Standard output for reading alone: results that go there are lost, and whoever writes them must be told.
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
    if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", fd == STDERR_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
}

void say(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

}  // namespace kage::cli
