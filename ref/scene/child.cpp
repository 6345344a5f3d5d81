// SPDX-License-Identifier: Apache-2.0
#include "child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <fstream>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "file/regular_file.hpp"
#include "import.hpp"
#include "kage/error.hpp"
#include "module/loader_lock.hpp"
#include "notes.hpp"
#include "wire.hpp"

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

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

/// How long a child may wait, by how many children were tried.
constexpr Clock::duration kPatience[] = {std::chrono::seconds(1), std::chrono::seconds(2), std::chrono::seconds(4),
                                         Clock::duration::max()};

// What the child's first byte says; a message or a packed scene follows, then its end is the pipe's end.
constexpr std::uint8_t kScene = 'S';
constexpr std::uint8_t kError = 'E';
constexpr std::uint8_t kNoMemory = 'M';
constexpr std::uint8_t kDone = '.';  // the last byte: nothing is missing

// A reader's last words are not for the user: the parent says in one line what happened. A sanitizer's report must be
// seen, so under AddressSanitizer the report keeps its way out, and the handlers that write it stay.
void fall_silent() {
#ifdef KAGE_ADDRESS_SANITIZER
  __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(dup(STDERR_FILENO))));
#else
  for (const int s : {SIGHUP, SIGINT, SIGQUIT, SIGILL, SIGABRT, SIGFPE, SIGSEGV, SIGBUS, SIGTERM, SIGXCPU, SIGPIPE})
    std::signal(s, SIG_DFL);
#endif
  const int null = open("/dev/null", O_RDWR);
  if (null < 0) return;
  dup2(null, STDOUT_FILENO);
  dup2(null, STDERR_FILENO);
}

std::int64_t positive(const char* variable, std::int64_t otherwise, std::int64_t most) {
  const char* text = std::getenv(variable);
  if (text == nullptr || *text == '\0') return otherwise;
  std::int64_t value = 0;
  const char* end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, value);
  if (error != std::errc() || stop != end || value < 1 || value > most)
    throw Error(std::string(variable) + ": '" + one_line(text, 40) + "' is not a number from 1 to " +
                std::to_string(most));
  return value;
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

/// Whether the process as a whole may have only so much memory.
bool limited_from_outside() {
  rlimit r{};
  return getrlimit(RLIMIT_AS, &r) == 0 && r.rlim_cur != RLIM_INFINITY;
}

void write_all(int fd, const void* data, std::size_t size) {
  const auto* p = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = write(fd, p, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) _exit(3);  // the parent is gone
    p += n;
    size -= static_cast<std::size_t>(n);
  }
}

void answer(int fd, std::uint8_t kind, std::string_view text) {
  write_all(fd, &kind, 1);
  write_all(fd, text.data(), text.size());
  write_all(fd, &kDone, 1);
}

[[noreturn]] void child(int fd, pid_t parent, const std::string& name, const ImportLimits& limits,
                        const std::function<Bytes()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(3);  // it died before prctl
  fall_silent();
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.seconds) + 1);
  limit_memory(limits.mib);
  try {
    const Bytes result = work();
    write_all(fd, &kScene, 1);
    write_all(fd, result.data(), result.size());
    write_all(fd, &kDone, 1);
  } catch (const std::bad_alloc&) {
    answer(fd, kNoMemory, "");
  } catch (const std::length_error&) {  // of a container: a count that no memory can hold
    answer(fd, kNoMemory, "");
  } catch (const Error& e) {
    answer(fd, kError, e.what());
  } catch (const std::exception& e) {
    answer(fd, kError, name + ": " + cause_of(e.what()));
  } catch (...) {
    answer(fd, kError, name + ": unknown exception");
  }
  _exit(0);
}

/// kStill: the child waits, and has for as long as `patience` says.
enum class Ending { kClosed, kLate, kLarge, kStill };

/// Processor time of another process; a child that has ended keeps it until it is waited for.
std::chrono::nanoseconds processor_time(pid_t pid) {
  clockid_t clock{};
  timespec t{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &t) != 0) return {};
  return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}

struct Child {
  pid_t pid;
  int pipe;  ///< the reading end
};

Ending receive(const Child& child, const ImportLimits& limits, Clock::time_point deadline, Clock::duration patience,
               const std::function<void()>& wait, Bytes& bytes) {
  const std::uint64_t most = static_cast<std::uint64_t>(limits.mib) << 20;
  Bytes chunk(std::size_t{1} << 16);
  std::chrono::nanoseconds worked{};
  Clock::time_point moved = Clock::now();
  for (;;) {
    const Clock::time_point now = Clock::now();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - now).count();
    if (left <= 0) return Ending::kLate;
    if (const auto w = processor_time(child.pid); w != worked) worked = w, moved = now;
    if (now - moved > patience) return Ending::kStill;
    pollfd p{child.pipe, POLLIN, 0};
    const int ready = poll(&p, 1, static_cast<int>(std::min<std::int64_t>(left, 100)));
    if (wait) wait();
    if (ready <= 0) continue;  // a signal, or a tenth of a second gone
    const ssize_t n = read(child.pipe, chunk.data(), chunk.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return Ending::kClosed;
    if (bytes.size() + static_cast<std::size_t>(n) > most) return Ending::kLarge;
    bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + n);
    moved = Clock::now();
  }
}

Child begin(const std::string& name, const ImportLimits& limits, const std::function<Bytes()>& work) {
  // One at a time, or another thread's child would inherit this pipe's writing end and keep it open.
  std::unique_lock<std::mutex> lock(loader_lock());
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) throw Error(name + ": no pipe to an import process: " + std::strerror(errno));
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) {
    const int error = errno;
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    throw Error(name + ": no import process: " + std::strerror(error));
  }
  if (pid == 0) {
    lock.unlock();  // the child's own copy of it
    close(pipe_ends[0]);
    child(pipe_ends[1], parent, name, limits, work);
  }
  close(pipe_ends[1]);
  return {pid, pipe_ends[0]};
}

/// What became of a child. `status` is none where the program reaps all children itself.
struct Outcome {
  Ending ending = Ending::kLarge;
  Bytes bytes;
  std::optional<int> status;
};

Outcome run_once(const std::string& name, const ImportLimits& limits, const std::function<Bytes()>& work,
                 const std::function<void()>& wait, Clock::time_point deadline, Clock::duration patience) {
  const Child child = begin(name, limits, work);
  Outcome o;
  std::exception_ptr stopped;
  try {
    o.ending = receive(child, limits, deadline, patience, wait, o.bytes);
  } catch (const std::bad_alloc&) {  // ours: the scene does not fit
  } catch (...) {
    stopped = std::current_exception();
  }
  close(child.pipe);
  if (o.ending != Ending::kClosed) kill(child.pid, SIGKILL);
  int status = 0;
  pid_t ended = -1;
  do ended = waitpid(child.pid, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (ended == child.pid) o.status = status;
  if (stopped) std::rethrow_exception(stopped);
  if (wait) wait();  // the signal that ended the child may have been for both, as Ctrl-C at a terminal is
  return o;
}

void check_file(const std::filesystem::path& path, const std::string& name) {
  check_regular(path, name);
  std::error_code error;
  if (std::filesystem::file_size(path, error) == 0 && !error) throw Error(name + ": is empty");
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) throw Error(name + ": cannot be read: " + std::string(std::strerror(errno)));
  close(fd);
}

}  // namespace

ImportLimits ImportLimits::from_environment() {
  ImportLimits limits;
  limits.seconds = static_cast<int>(positive("KAGE_IMPORT_SECONDS", limits.seconds, 1'000'000));
  limits.mib = positive("KAGE_IMPORT_MIB", limits.mib, 1 << 30);
  return limits;
}

Bytes run_in_child(const std::string& name, const ImportLimits& limits, const std::function<Bytes()>& work,
                   const std::function<void()>& wait) {
  const std::string no_time = name + ": import took longer than " + std::to_string(limits.seconds) + " s";
  const std::string no_memory = name + ": import needs more than " + std::to_string(limits.mib) + " MiB" +
                                (limited_from_outside() ? ", or than ulimit -v leaves" : "");
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(limits.seconds);
  // A child that waits may have inherited a lock that none of its threads will give back (child.hpp): another child is
  // tried. One that waits for a slow disk looks the same, so each is given more patience, and the last has all the
  // time.
  Outcome o;
  for (const Clock::duration patience : kPatience) {
    o = run_once(name, limits, work, wait, deadline, patience);
    if (o.ending != Ending::kStill) break;
  }
  if (o.ending == Ending::kLate) throw Error(no_time);
  if (o.ending == Ending::kLarge) throw Error(no_memory);
  const int signal = o.status && WIFSIGNALED(*o.status) ? WTERMSIG(*o.status) : 0;
  if (signal == SIGXCPU) throw Error(no_time);
  if (signal != 0) throw Error(name + ": killed by signal " + std::to_string(signal) + " while importing");
  Bytes& bytes = o.bytes;
  if (bytes.size() < 2 || bytes.back() != kDone) {
    const std::string code =
        o.status && WIFEXITED(*o.status) ? " with code " + std::to_string(WEXITSTATUS(*o.status)) : "";
    throw Error(name + ": the import process ended" + code + " and gave no scene");
  }
  const std::uint8_t kind = bytes.front();
  bytes.pop_back();
  bytes.erase(bytes.begin());
  if (kind == kNoMemory) throw Error(no_memory);
  if (kind == kError) throw Error(std::string(bytes.begin(), bytes.end()));
  return bytes;
}

RawScene import_in_child(const std::filesystem::path& path, const std::string& name, bool allow_outside,
                         const std::function<void()>& wait) {
  check_file(path, name);
  const Bytes bytes = run_in_child(
      name, ImportLimits::from_environment(), [&] { return packed(import_file(path, name, allow_outside)); }, wait);
  try {
    return unpacked(bytes);
  } catch (const std::exception& e) {
    throw Error(name + ": " + e.what());
  }
}

}  // namespace kage::scene
