// SPDX-License-Identifier: Apache-2.0
// Code that is not kage's and ends by a signal is told of in one line, with the exit code; kage's own is not.
#include "plugin/foreign_code.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <functional>
#include <string>
#include <thread>

#include "test/support/catch.hpp"

using namespace kage;

namespace {

struct Ending {
  int code = -1;   // exit code, or
  int signal = 0;  // the signal that ended it
  std::string said;
};

/// The end of the work in a process of its own, which reports errors as kage does.
Ending ending_of(const std::function<void()>& work) {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  const pid_t child = fork();
  if (child == 0) {
    rlimit none{};
    setrlimit(RLIMIT_CORE, &none);
    dup2(ends[1], STDERR_FILENO);
    for (const int s : {SIGSEGV, SIGABRT, SIGFPE, SIGILL}) (void)std::signal(s, SIG_DFL);  // Catch2 has its own
    tell_foreign_ends(2);
    work();
    _exit(0);
  }
  close(ends[1]);
  Ending e;
  std::array<char, 512> piece{};
  for (ssize_t n = 0; (n = read(ends[0], piece.data(), piece.size())) > 0;)
    e.said.append(piece.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  if (WIFEXITED(status)) e.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) e.signal = WTERMSIG(status);
  return e;
}

void fault() {
  volatile int* volatile nowhere = nullptr;
  *nowhere = 1;
}

// NOLINTNEXTLINE(misc-no-recursion): that is what is tried
int deeper(int n) {
  volatile char room[4096];
  room[0] = static_cast<char>(n);
  return n < 0 ? 0 : deeper(n + 1) + room[0];
}

}  // namespace

TEST_CASE("a signal within foreign code is one line and the exit code, whichever it is") {
  for (const auto& [number, name] :
       {std::pair{SIGSEGV, "SIGSEGV"}, {SIGABRT, "SIGABRT"}, {SIGFPE, "SIGFPE"}, {SIGILL, "SIGILL"}}) {
    const Ending e = ending_of([n = number] {
      const ForeignCode mark("a.dds\n");
      raise(n);
    });
    CHECK(e.code == 2);
    CHECK(e.said == std::string("kage: a.dds : ended by ") + name + ": a defect there, or no memory\n");
  }
}

TEST_CASE("the innermost mark of the thread counts, and none behind its end") {
  const auto line = [](const std::string& what) {
    return "kage: " + what + ": ended by SIGSEGV: a defect there, or no memory\n";
  };
  CHECK(ending_of([] {
          const ForeignCode outer("outer");
          { const ForeignCode inner("inner"); }
          fault();
        }).said == line("outer"));
  CHECK(ending_of([] {
          const ForeignCode outer("outer");
          const ForeignCode inner(std::string(1000, 'x'));
          fault();
        }).said == line(std::string(400, 'x')));
  CHECK(ending_of([] {
          const ForeignCode mark("other thread's");
          std::thread([] {
            const ForeignCode own("own");
            fault();
          }).join();
        }).said == line("own"));
  CHECK(ending_of([] {
          const ForeignCode mark("deep");
          _exit(deeper(0) & 1);
        }).said == line("deep"));
}

TEST_CASE("kage's own end by a signal stays one") {
  for (const auto& work : std::vector<std::function<void()>>{fault, [] { std::abort(); },
                                                             [] {
                                                               { const ForeignCode mark("before"); }
                                                               fault();
                                                             },
                                                             [] {
                                                               const ForeignCode mark("other thread's");
                                                               std::thread(fault).join();
                                                             }}) {
    const Ending e = ending_of(work);
    CHECK((e.signal == SIGSEGV || e.signal == SIGABRT));
    CHECK(e.said.empty());
  }
}
