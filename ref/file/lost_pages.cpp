// SPDX-License-Identifier: Apache-2.0
#include "file/lost_pages.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>

namespace kage {
namespace {

std::atomic<int> lost{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler counts by it");
std::uintptr_t page_size = 0;

// mmap() is a plain system call on Linux and safe here, though POSIX does not list it.
void on_bus(int number, siginfo_t* info, void*) {
  const int saved = errno;
  char* page = static_cast<char*>(info->si_addr);
  page -= reinterpret_cast<std::uintptr_t>(page) % page_size;
  const bool zeros = info->si_code == BUS_ADRERR && mmap(page, page_size, PROT_READ | PROT_WRITE,
                                                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED;
  if (zeros)
    ++lost;
  else
    (void)std::signal(number, SIG_DFL);  // the access is repeated, and ends the program
  errno = saved;
}

}  // namespace

void guard_pages() {
  page_size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  struct sigaction action = {};
  action.sa_sigaction = on_bus;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

int lost_pages() { return lost; }

void forget_lost_pages(int count) { lost = count; }

}  // namespace kage
