// SPDX-License-Identifier: Apache-2.0
#include "mapped.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <vector>

#include "kage/error.hpp"

namespace kage::cli {
namespace {

volatile std::sig_atomic_t lost = 0;
std::uintptr_t page_size = 0;

struct Guarded {
  std::string name;
  std::uintmax_t size;
};
std::vector<Guarded> files;

std::uintmax_t size_now(const std::string& name) {
  std::error_code ec;
  return std::filesystem::file_size(name, ec);
}

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
  files.push_back({name, size_now(name)});
  page_size = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  struct sigaction action = {};
  action.sa_sigaction = on_bus;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

std::string lost_mapped() {
  if (lost == 0) return "";
  // The page that was lost does not say whose it was; the size does, if the file became shorter.
  std::string all;
  std::string changed;
  for (const Guarded& file : files) {
    all += (all.empty() ? "" : " or ") + file.name;
    if (size_now(file.name) != file.size) changed += (changed.empty() ? "" : " and ") + file.name;
  }
  return (changed.empty() ? all : changed) + ": became shorter, or could not be read, while it was open";
}

void check_mapped() {
  if (lost != 0) throw Error(lost_mapped());
}

}  // namespace kage::cli
