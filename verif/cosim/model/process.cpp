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

#include "kage/error.hpp"

namespace kage::cosim {
namespace {

[[noreturn]] void fail(const std::vector<std::string>& command, int error) {
  throw Error(fmt::format("{}: cannot be started: {}", command[0], std::strerror(error)));
}

/// Between fork() and execvp() no memory may be asked for: another thread may have held its lock.
[[noreturn]] void execute(char* const* argv, int output, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);  // it died before prctl
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execvp(argv[0], argv);
  _exit(127);
}

}  // namespace

Process::Process(const std::vector<std::string>& command) {
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail(command, errno);
  output_ = ends[0];
  (void)fcntl(output_, F_SETFL, O_NONBLOCK);
  // What its tools leave behind when they are ended comes to this process, so that their end can be waited for.
  (void)prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) execute(argv.data(), ends[1], parent);
  const int error = errno;
  (void)close(ends[1]);
  if (pid_ < 0) {
    (void)close(output_);
    fail(command, error);
  }
  setpgid(pid_, pid_);  // by both: it has to be so before either goes on
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
