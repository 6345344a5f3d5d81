// SPDX-License-Identifier: Apache-2.0
// What a command costs before its work: processor time and memory of small commands, each run as a program of its own.
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

extern char** environ;

namespace {

struct Cost {
  double milliseconds = 0;  // of processor time, user and system, children's too
  double mib = 0;           // resident at most
};

Cost run(std::vector<std::string> words) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage used{};
  if (failed != 0 || wait4(child, &status, 0, &used) != child || status != 0) {
    std::fprintf(stderr, "startup: %s %s failed\n", words[0].c_str(), words[1].c_str());
    std::exit(1);
  }
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return {ms(used.ru_utime) + ms(used.ru_stime), static_cast<double>(used.ru_maxrss) / 1024};
}

}  // namespace

int main() {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("kage-startup-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string kage = KAGE_PROGRAM;
  const std::string stream = (folder / "small.kage").string();
  const std::string mesh = KAGE_SOURCE_DIR "/scenes/fifteen.gltf";
  const std::vector<std::vector<std::string>> commands{
      {kage, "stream", "fifteen", "--size", "64x48", "--frames", "1", "--out", stream},
      {kage, "--version"},
      {kage, "list"},
      {kage, "info", stream},
      {kage, "order", mesh, "--eyes", "3"},
      {kage, "render", stream, "--out", folder.string()},
      {kage, "diff", (folder / "small_0000.png").string(), (folder / "small_0000.png").string()}};
  run(commands[0]);
  run(commands[5]);
  std::printf("%-10s %22s %14s\n", "command", "processor time, ms", "memory, MiB");
  std::printf("%-10s %7s %7s %7s\n", "", "least", "median", "most");
  constexpr int kRuns = 21;
  for (const std::vector<std::string>& words : commands) {
    std::vector<double> times;
    double mib = 0;
    for (int i = 0; i < kRuns; ++i) {
      const Cost cost = run(words);
      times.push_back(cost.milliseconds);
      mib = std::max(mib, cost.mib);
    }
    std::sort(times.begin(), times.end());
    std::printf("%-10s %7.1f %7.1f %7.1f %13.1f\n", words[1].c_str(), times.front(), times[kRuns / 2], times.back(),
                mib);
  }
  fs::remove_all(folder);
  return 0;
}
