// SPDX-License-Identifier: Apache-2.0
#include "mapped.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>

#include "kage/error.hpp"

namespace kage::cli {
namespace {

volatile std::sig_atomic_t lost = 0;
std::uintptr_t page_size = 0;
std::string file_name;

// mmap() is a plain system call on Linux and safe here, though POSIX does not list it.
void on_bus(int number, siginfo_t* info, void*) {
  const int saved = errno;
  char* page = static_cast<char*>(info->si_addr);
  page -= reinterpret_cast<std::uintptr_t>(page) % page_size;
  const bool zeros = info->si_code == BUS_ADRERR &&
                     mmap(page, page_size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED;
  if (zeros)
    lost = 1;
  else
    (void)std::signal(number, SIG_DFL);  // the access is repeated, and ends the program
  errno = saved;
}

}  // namespace

void guard_mapped(const std::string& name) {
  file_name = name;
  page_size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  struct sigaction action = {};
  action.sa_sigaction = on_bus;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

std::string lost_mapped() {
  return lost != 0 ? file_name + ": became shorter, or could not be read, while it was open" : std::string();
}

void check_mapped() {
  if (lost != 0) throw Error(lost_mapped());
}

}  // namespace kage::cli
