// SPDX-License-Identifier: Apache-2.0
#include "image/memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "kage/error.hpp"

namespace kage {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

/// The first number of a file; none if it has none, as "max".
std::uint64_t number_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  return in >> number ? number : kNoLimit;
}

/// Bytes that the machine has free, or can make free.
std::uint64_t free_bytes() {
  std::ifstream in("/proc/meminfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("MemAvailable:")) return std::stoull(line.substr(13)) * 1024;
  return kNoLimit;
}

/// The bytes that control groups leave (version 2): each folder on the way up may have a limit.
std::uint64_t bytes_of_groups() {
  std::ifstream in("/proc/self/cgroup");
  std::uint64_t least = kNoLimit;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("0::/")) continue;
    const std::filesystem::path root = "/sys/fs/cgroup";
    for (std::filesystem::path group = root / line.substr(4);; group = group.parent_path()) {
      const std::uint64_t most = number_in(group / "memory.max");
      const std::uint64_t used = number_in(group / "memory.current");
      if (most != kNoLimit && used != kNoLimit) least = std::min(least, most - std::min(most, used));
      if (group == root || group == group.parent_path()) break;
    }
  }
  return least;
}

/// The bytes that `ulimit` leaves of those that are counted in column `at` of /proc/self/statm.
std::uint64_t bytes_of_limit(__rlimit_resource resource, int at) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kNoLimit;
  std::ifstream in("/proc/self/statm");
  std::uint64_t pages = 0;
  for (int i = 0; i <= at; ++i) in >> pages;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

std::string text_of(std::uint64_t bytes) { return fmt::format("{} MiB", (bytes + (1U << 20U) - 1) >> 20U); }

}  // namespace

std::uint64_t half_of_memory() {
  return std::min({free_bytes(), bytes_of_groups(), bytes_of_limit(RLIMIT_AS, 0), bytes_of_limit(RLIMIT_DATA, 5)}) / 2;
}

void check_memory(const char* what, std::uint64_t bytes, std::optional<std::uint64_t> most) {
  const std::uint64_t limit = most ? *most : half_of_memory();
  if (bytes <= limit) return;
  throw Error(fmt::format("{} {} of memory, and {} {}", what, text_of(bytes), text_of(limit),
                          most ? "are what --max-memory allows"
                               : "are half of what there is (kage diff --max-memory MIB sets another limit)"));
}

}  // namespace kage
