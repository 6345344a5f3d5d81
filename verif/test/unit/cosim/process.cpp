// SPDX-License-Identifier: Apache-2.0
// Programs that are started: their words, and the cause where they cannot be.
#include "cosim/model/process.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::cosim;

namespace {

/// The words of a program until its end, and whether it succeeded.
std::pair<std::string, bool> run(const std::vector<std::string>& command, Said kept) {
  Process process(command, kept);
  bool ok = false;
  while (!process.ended(ok)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return {process.said(), ok};
}

/// errno as NotStarted has it; 0 if the program starts.
int cause_of(const std::vector<std::string>& command) {
  try {
    (void)run(command, Said::all);
  } catch (const NotStarted& e) {
    CHECK(std::string(e.what()).starts_with(command[0] + ": cannot be started: "));
    return e.cause();
  }
  return 0;
}

/// So few open files until the end of the scope.
class FewFiles {
 public:
  explicit FewFiles(rlim_t files) {
    REQUIRE(getrlimit(RLIMIT_NOFILE, &before_) == 0);
    rlimit less = before_;
    less.rlim_cur = files;
    REQUIRE(setrlimit(RLIMIT_NOFILE, &less) == 0);
  }
  ~FewFiles() { (void)setrlimit(RLIMIT_NOFILE, &before_); }
  FewFiles(const FewFiles&) = delete;
  FewFiles& operator=(const FewFiles&) = delete;

 private:
  rlimit before_{};
};

}  // namespace

TEST_CASE("a program's words are kept as asked for") {
  const std::vector<std::string> command{"sh", "-c", "echo output; echo trouble >&2; exit 3"};
  CHECK(run(command, Said::all) == std::pair{std::string("output\ntrouble\n"), false});
  CHECK(run(command, Said::output) == std::pair{std::string("output\n"), false});
  CHECK(run({"sh", "-c", "read line || echo none"}, Said::all) == std::pair{std::string("none\n"), true});
}

TEST_CASE("a program that cannot be started is told from one that fails, by its cause") {
  CHECK(cause_of({"kage-none-such"}) == ENOENT);
  CHECK(cause_of({"/dev/null/none"}) == ENOTDIR);
  CHECK(cause_of({"/"}) == EACCES);
  CHECK(cause_of({"sh", "-c", "exit 127"}) == 0);
  // From three files on, which this process has, up to those that a program needs.
  int last = EMFILE;
  for (rlim_t files = 3; files < 20; ++files) {
    int cause = 0;
    {
      const FewFiles few(files);
      cause = cause_of({"true"});
    }
    CAPTURE(files);
    CHECK((cause == EMFILE || cause == 0));
    CHECK((cause == 0 || last == EMFILE));  // once there are enough, there are enough
    last = cause;
  }
  CHECK(last == 0);
}
