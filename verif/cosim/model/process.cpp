// SPDX-License-Identifier: Apache-2.0
#include "cosim/model/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace kage::cosim {
namespace {

/// The two ends of a pipe; no program that is started gets them.
class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) ends_ = {-1, -1};
  }
  ~Pipe() {
    for (const int end : ends_)
      if (end >= 0) (void)close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] bool made() const { return ends_[0] >= 0; }
  [[nodiscard]] int in() const { return ends_[1]; }
  [[nodiscard]] int out() const { return ends_[0]; }
  int take_out() { return std::exchange(ends_[0], -1); }
  void close_in() { (void)close(std::exchange(ends_[1], -1)); }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// Between fork() and execvp() no memory may be asked for: another thread may have held its lock. `failure` takes errno
/// where the program cannot be run.
[[noreturn]] void execute(char* const* argv, int output, Said kept, int failure, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);  // it died before prctl
  dup2(output, STDOUT_FILENO);
  if (kept == Said::all) dup2(output, STDERR_FILENO);
  if (output > STDERR_FILENO) close(output);  // where no more files may be open, there is one for this
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  if (kept == Said::output) dup2(nothing, STDERR_FILENO);
  execvp(argv[0], argv);
  const int error = errno;
  (void)!write(failure, &error, sizeof error);
  _exit(127);
}

/// The errno that execute() wrote; 0 once the program runs.
int failure_in(int pipe) {
  int error = 0;
  while (true) {
    const ssize_t n = read(pipe, &error, sizeof error);
    if (n >= 0 || errno != EINTR) return n == sizeof error ? error : 0;
  }
}

}  // namespace

NotStarted::NotStarted(const std::string& program, int cause)
    : Error(fmt::format("{}: cannot be started: {}", program, std::strerror(cause))), cause_(cause) {}

Process::Process(const std::vector<std::string>& command, Said kept) {
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  Pipe output;
  Pipe failure;
  if (!output.made() || !failure.made()) throw NotStarted(command[0], errno);
  (void)fcntl(output.out(), F_SETFL, O_NONBLOCK);
  // Processes that its tools leave behind when they are ended come to this process, so that their end can be waited
  // for.
  (void)prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) execute(argv.data(), output.in(), kept, failure.in(), parent);
  if (pid_ < 0) throw NotStarted(command[0], errno);
  setpgid(pid_, pid_);  // by both: it has to be so before either goes on
  output.close_in();
  failure.close_in();
  if (const int error = failure_in(failure.out()); error != 0) {
    waitpid(pid_, nullptr, 0);
    throw NotStarted(command[0], error);
  }
  output_ = output.take_out();
}

Process::~Process() {
  if (pid_ > 0) end();
  (void)close(output_);
}

bool Process::ended(bool& ok) {
  read_output();
  siginfo_t info{};
  // It stays a zombie for the moment: until it is gone its number, which is that of the group, is no other's.
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0) return false;
  ok = info.si_code == CLD_EXITED && info.si_status == 0;
  end();
  read_output();
  return true;
}

void Process::end() {
  kill(-pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  while (waitpid(-pid_, nullptr, 0) > 0) continue;
  pid_ = 0;
}

void Process::read_output() {
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = read(output_, buffer.data(), buffer.size())) > 0;)
    said_.append(buffer.data(), static_cast<std::size_t>(n));
}

}  // namespace kage::cosim
