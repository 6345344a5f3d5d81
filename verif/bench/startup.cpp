// SPDX-License-Identifier: Apache-2.0
// Cost of a command before its work: processor time and memory of small commands, each run as a program of its own.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/program.hpp"

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
  using kage::bench::run_program;
  run_program(commands[0]);
  run_program(commands[5]);
  std::printf("%-10s %22s %14s\n", "command", "processor time, ms", "memory, MiB");
  std::printf("%-10s %7s %7s %7s\n", "", "least", "median", "most");
  constexpr int kRuns = 21;
  for (const std::vector<std::string>& words : commands) {
    std::vector<double> times;
    double mib = 0;
    for (int i = 0; i < kRuns; ++i) {
      const kage::bench::ProgramCost cost = run_program(words);
      times.push_back(1e3 * cost.processor);
      mib = std::max(mib, cost.mib);
    }
    std::sort(times.begin(), times.end());
    std::printf("%-10s %7.1f %7.1f %7.1f %13.1f\n", words[1].c_str(), times.front(), times[kRuns / 2], times.back(),
                mib);
  }
  fs::remove_all(folder);
  return 0;
}
