// SPDX-License-Identifier: Apache-2.0
#include "standard_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace kage::cli {

void open_standard_files() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
    if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", fd == STDIN_FILENO ? O_RDONLY : O_WRONLY) < 0) return;
}

void say(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

}  // namespace kage::cli
