// SPDX-License-Identifier: Apache-2.0
#include "file/hidden_folder.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"

namespace fs = std::filesystem;

namespace {

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a process that is killed at any moment leaves no hidden folder whose files git would add") {
  const kage::test::TempDirectory scratch;
  int left = 0;
  for (int i = 0; i < 400; ++i) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      while (true) {
        const kage::HiddenFolder folder(scratch.path());
        std::ofstream(folder.new_name(".txt")) << "unfinished";
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(1000 + 37 * (i % 50)));
    kill(child, SIGKILL);
    REQUIRE(waitpid(child, nullptr, 0) == child);
    for (const auto& entry : fs::directory_iterator(scratch.path())) {
      ++left;
      if (!fs::is_empty(entry.path())) {
        const std::string ignored = text_of(entry.path() / ".gitignore");
        CHECK(ignored.substr(0, ignored.find('\n')) == "*");
      }
    }
    kage::HiddenFolder::sweep(scratch.path());
    CHECK(fs::is_empty(scratch.path()));
  }
  CHECK(left > 0);  // the moments are those at which there is a folder
}
