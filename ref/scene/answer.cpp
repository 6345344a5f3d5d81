// SPDX-License-Identifier: Apache-2.0
#include "answer.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <exception>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string_view>

#include "kage/error.hpp"
#include "notes.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define KAGE_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define KAGE_ADDRESS_SANITIZER
#endif
#endif
#ifdef KAGE_ADDRESS_SANITIZER
#include <sanitizer/common_interface_defs.h>
#endif

namespace kage::scene {
namespace {

// A reader's last words are not for the user: the parent says in one line what happened. A sanitizer's report must be
// seen, so under AddressSanitizer the report keeps its way out, and the handlers that write it stay.
void fall_silent() {
#ifdef KAGE_ADDRESS_SANITIZER
  __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(dup(STDERR_FILENO))));
#endif
  const int null = open("/dev/null", O_RDWR);
  if (null < 0) return;
  dup2(null, STDOUT_FILENO);
  dup2(null, STDERR_FILENO);
}

void limit(int resource, std::uint64_t value) {
  rlimit r{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &r) != 0) return;
  r.rlim_cur = std::min<rlim_t>(r.rlim_max, value);
  setrlimit(static_cast<__rlimit_resource>(resource), &r);
}

// RLIMIT_DATA counts private writable memory, which is what an importer eats. RLIMIT_AS would also count what the
// program has mapped, and the terabytes that sanitizers reserve.
void limit_memory(std::int64_t mib) {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t pages[6] = {};
  for (std::uint64_t& p : pages) statm >> p;
  if (!statm) return;
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  limit(RLIMIT_DATA, pages[5] * page + (static_cast<std::uint64_t>(mib) << 20));
}

void write_all(const void* data, std::size_t size) {
  const auto* p = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = write(kAnswerPipe, p, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) _exit(3);  // the parent is gone
    p += n;
    size -= static_cast<std::size_t>(n);
  }
}

void say(std::uint8_t kind, std::string_view text) {
  write_all(&kind, 1);
  write_all(text.data(), text.size());
  write_all(&kDone, 1);
}

}  // namespace

[[noreturn]] void answer(int parent, const std::string& name, const ImportLimits& limits,
                         const std::function<std::vector<std::uint8_t>()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(3);  // it died before prctl
  fall_silent();
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.seconds) + 1);
  limit_memory(limits.mib);
  try {
    const std::vector<std::uint8_t> result = work();
    write_all(&kScene, 1);
    write_all(result.data(), result.size());
    write_all(&kDone, 1);
  } catch (const std::bad_alloc&) {
    say(kNoMemory, "");
  } catch (const std::length_error&) {  // of a container: a count that no memory can hold
    say(kNoMemory, "");
  } catch (const Error& e) {
    say(kError, e.what());
  } catch (const std::exception& e) {
    say(kError, name + ": " + cause_of(e.what()));
  } catch (...) {
    say(kError, name + ": unknown exception");
  }
  _exit(0);
}

}  // namespace kage::scene
