// SPDX-License-Identifier: Apache-2.0
#include "child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
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
#include <exception>
#include <new>
#include <optional>

#include "answer.hpp"
#include "file/regular_file.hpp"
#include "kage/error.hpp"
#include "notes.hpp"
#include "plugin/plugin.hpp"
#include "wire.hpp"

namespace kage::scene {
namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

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

/// Whether the process as a whole may have only so much memory.
bool limited_from_outside() {
  rlimit r{};
  return getrlimit(RLIMIT_AS, &r) == 0 && r.rlim_cur != RLIM_INFINITY;
}

enum class Ending { kClosed, kLate, kLarge };

struct Child {
  pid_t pid;
  int pipe;  ///< the reading end
};

Ending receive(const Child& child, const ImportLimits& limits, Clock::time_point deadline,
               const std::function<void()>& wait, Bytes& bytes) {
  const std::uint64_t most = static_cast<std::uint64_t>(limits.mib) << 20;
  Bytes chunk(std::size_t{1} << 16);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return Ending::kLate;
    pollfd p{child.pipe, POLLIN, 0};
    const int ready = poll(&p, 1, static_cast<int>(std::min<std::int64_t>(left, 100)));
    if (wait) wait();
    if (ready <= 0) continue;  // a signal, or a tenth of a second gone
    const ssize_t n = read(child.pipe, chunk.data(), chunk.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return Ending::kClosed;
    if (bytes.size() + static_cast<std::size_t>(n) > most) return Ending::kLarge;
    bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + n);
  }
}

/// The inheritance of a started process: the pipe as kAnswerPipe and standard error, no signal that is blocked or
/// ignored.
class SpawnSettings {
 public:
  explicit SpawnSettings(int pipe) {
    posix_spawn_file_actions_init(&files_);
    posix_spawn_file_actions_adddup2(&files_, pipe, kAnswerPipe);
    posix_spawn_file_actions_addclosefrom_np(&files_, kAnswerPipe + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t none;
    sigset_t all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* files() const { return &files_; }
  [[nodiscard]] const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t files_{};
  posix_spawnattr_t attributes_{};
};

Child begin(const std::vector<std::string>& command, const std::string& name) {
  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) throw Error(name + ": no pipe to an import process: " + std::strerror(errno));
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  // dup2() onto itself would leave the end to be closed by exec.
  const int writing =
      pipe_ends[1] == kAnswerPipe ? fcntl(pipe_ends[1], F_DUPFD_CLOEXEC, kAnswerPipe + 1) : pipe_ends[1];
  pid_t pid = -1;
  const SpawnSettings settings(writing);
  const int error = posix_spawn(&pid, arguments[0], settings.files(), settings.attributes(), arguments.data(), environ);
  if (writing != pipe_ends[1]) close(writing);
  close(pipe_ends[1]);
  if (error == 0) return {pid, pipe_ends[0]};
  close(pipe_ends[0]);
  throw Error(name + ": no import process: " + command[0] + ": " + std::strerror(error));
}

/// The end of a child. `status` is none where the program reaps all children itself.
struct Outcome {
  Ending ending = Ending::kLarge;
  Bytes bytes;
  std::optional<int> status;
};

Outcome run(const std::vector<std::string>& command, const std::string& name, const ImportLimits& limits,
            const std::function<void()>& wait, Clock::time_point deadline) {
  const Child child = begin(command, name);
  Outcome o;
  std::exception_ptr stopped;
  try {
    o.ending = receive(child, limits, deadline, wait, o.bytes);
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

Bytes answer_of(const std::vector<std::string>& command, const std::string& name, const ImportLimits& limits,
                const std::function<void()>& wait) {
  const std::string no_time = name + ": import took longer than " + std::to_string(limits.seconds) + " s";
  const std::string no_memory = name + ": import needs more than " + std::to_string(limits.mib) + " MiB" +
                                (limited_from_outside() ? ", or than ulimit -v leaves" : "");
  const Clock::time_point deadline = Clock::now() + std::chrono::seconds(limits.seconds);
  Outcome o = run(command, name, limits, wait, deadline);
  if (o.ending == Ending::kLate) throw Error(no_time);
  if (o.ending == Ending::kLarge) throw Error(no_memory);
  const int signal = o.status && WIFSIGNALED(*o.status) ? WTERMSIG(*o.status) : 0;
  if (signal == SIGXCPU) throw Error(no_time);
  if (signal != 0) throw Error(name + ": killed by signal " + std::to_string(signal) + " while importing");
  if (o.status && WIFEXITED(*o.status) && WEXITSTATUS(*o.status) == kOtherVersion)
    throw Error(name + ": " + command[0] + ": is not of kage " + kPluginVersion);
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
  const ImportLimits limits = ImportLimits::from_environment();
  const std::string helper = helper_file(kImporter, "no file of a scene can be read without it").string();
  const Bytes bytes = answer_of({helper, kPluginVersion, std::to_string(getpid()), std::to_string(limits.seconds),
                                 std::to_string(limits.mib), path.string(), name, allow_outside ? "1" : "0"},
                                name, limits, wait);
  try {
    return unpacked(bytes);
  } catch (const std::exception& e) {
    throw Error(name + ": " + e.what());
  }
}

}  // namespace kage::scene
