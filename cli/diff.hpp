// SPDX-License-Identifier: Apache-2.0
//
// kage diff: what its three sorts of comparison share.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "kage/diff.hpp"
#include "options.hpp"
#include "results.hpp"

namespace kage::cli {

struct DiffCommand : Options {
  std::string a;
  std::string b;
  DiffOptions limits;
  std::string mask;
  std::string blink;
  std::string junit;
  std::vector<std::string> exclude;  ///< patterns of names in folders
  bool bless = false;
  bool prune = false;
  bool dry_run = false;
  std::vector<std::string> given;  ///< options by name, as --lsb, that not every sort of comparison takes
};

int diff_two_pictures(const DiffCommand& o);
int diff_two_folders(const DiffCommand& o);
int diff_two_streams(const DiffCommand& o);
int bless_folder(const DiffCommand& o);

/// Throws Error if --out or another file to write is one of those compared, or lies in a folder that is.
void check_outputs(const DiffCommand& o);

/// Compares two files as the options say, with libraries' noise off standard error.
DiffResult compare_files(const std::filesystem::path& a, const std::filesystem::path& b, const DiffOptions& limits,
                         DiffViews* views);

/// Two stream files: whether they are the same, and the lines that say so.
std::pair<bool, std::string> compare_streams(const std::string& a, const std::string& b);

/// The outcome in one line, without files' names.
std::string describe(const DiffResult& result);

/// The lines that go with it where it is "different": where, and how it looks to measures that decide nothing.
std::string details(const DiffResult& result);

Json to_json(const DiffResult& result);

/// Seconds since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace kage::cli
