// SPDX-License-Identifier: Apache-2.0
// Runs the inputs that fuzzing begins with and those that it has found, without a fuzzer: a quick test in every build.
//
// usage: kage_fuzz_replay FOLDER            all seeds, some hundred neighbours of each, deep texts, and FOLDER/TARGET/*
//        kage_fuzz_replay --seeds FOLDER    writes the seeds as FOLDER/TARGET/NUMBER
//        kage_fuzz_replay --list            the targets and what each is
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "file/read_file.hpp"
#include "fuzz/target.hpp"
#include "kage/error.hpp"

namespace {

namespace fs = std::filesystem;
using namespace kage::fuzz;

/// A seed's neighbours: it cut off, and with a byte changed, at some hundred places.
int run_near(const Target& target, const std::string& seed) {
  int count = 0;
  const std::size_t step = std::max<std::size_t>(seed.size() / 100, 1);
  for (std::size_t at = 0; at < seed.size(); at += step) {
    run(target, bytes_of(seed.substr(0, at)));
    std::string changed = seed;
    changed[at] = static_cast<char>(changed[at] ^ (1 << at / step % 8));
    run(target, bytes_of(changed));
    count += 2;
  }
  return count;
}

/// Texts that open bracket after bracket, deeper than a stack goes. Too long to be kept as files.
int run_deep(const Target& target) {
  int count = 0;
  for (const std::string_view open : {"[", "{\"a\":", "- ", "{a: ", "("}) {
    std::string text;
    for (int i = 0; i < 100'000; ++i) text += open;
    run(target, bytes_of(text));
    ++count;
  }
  return count;
}

/// Each folder of inputs that were found is a target's, and there are some: otherwise they would no more be run.
void check_folders(const fs::path& found) {
  int folders = 0;
  for (const auto& entry : fs::directory_iterator(found)) {
    const std::string name = entry.path().filename().string();
    const auto all = targets();
    if (entry.is_directory() && std::none_of(all.begin(), all.end(), [&](const Target& t) { return t.name == name; }))
      throw kage::Error(fmt::format("{}: no target of this name", entry.path().string()));
    folders += entry.is_directory() ? 1 : 0;
  }
  if (folders == 0) throw kage::Error(fmt::format("{}: no inputs", found.string()));
}

int run_all(const fs::path& found) {
  check_folders(found);
  for (const Target& t : targets()) {
    const auto start = std::chrono::steady_clock::now();
    int count = 0;
    int files = 0;
    for (const std::string& seed : t.seeds()) {
      run(t, bytes_of(seed));
      count += 1 + run_near(t, seed);
    }
    count += run_deep(t);
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(found / t.name, ec)) {
      fmt::print("{}/{}\n", t.name, entry.path().filename().string());
      std::fflush(stdout);
      run(t, bytes_of(kage::read_file(entry.path())));
      ++files;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{}: {} inputs of seeds, {} that were found, {:.2f} s\n", t.name, count, files, seconds);
    std::fflush(stdout);
  }
  return 0;
}

int write_seeds(const fs::path& folder) {
  for (const Target& t : targets()) {
    fs::create_directories(folder / t.name);
    int number = 0;
    for (const std::string& seed : t.seeds())
      std::ofstream(folder / t.name / fmt::format("seed-{}", number++), std::ios::binary) << seed;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 1 && arguments[0] == "--list") {
      for (const Target& t : targets()) fmt::print("{}\t{}\n", t.name, t.about);
      return 0;
    }
    if (arguments.size() == 2 && arguments[0] == "--seeds") return write_seeds(arguments[1]);
    if (arguments.size() == 1) return run_all(arguments[0]);
    fmt::print(stderr, "usage: kage_fuzz_replay FOLDER | --seeds FOLDER | --list\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "kage_fuzz_replay: {}\n", e.what());
  }
  return 2;
}
