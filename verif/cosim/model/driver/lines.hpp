// SPDX-License-Identifier: Apache-2.0
//
// Which lines and branches of the RTL have run, as Verilator counts them (--coverage-line).
#pragma once

#ifdef KAGE_LINES
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <map>
#include <string>

#include "verilated.h"
#include "verilated_cov.h"

/// Verilator's text of a point: "C '" with fields {0x01, key, 0x02, value}, "' ", and its count. Keys: f file, l line,
/// o what it is ("block", "if", "else", ...).
inline std::string coverage_field(const std::string& line, const std::string& key) {
  const std::string begin = '\x01' + key + '\x02';
  const std::size_t at = line.find(begin);
  if (at == std::string::npos) return {};
  const std::size_t from = at + begin.size();
  return line.substr(from, line.find_first_of("\x01'", from) - from);
}

/// kage_rtl_table::lines. Verilator gives its counts to a file only: this one is in memory.
inline int tell_lines(VerilatedContext& context, void (*point)(void*, const char*, std::uint64_t), void* user) {
  const int file = memfd_create("kage-lines", MFD_CLOEXEC);
  if (file < 0) return -1;
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  context.coveragep()->write(path.c_str());
  std::map<std::string, std::uint64_t> counts;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const std::size_t end = line.rfind("' ");
    if (line.rfind("C '", 0) != 0 || end == std::string::npos) continue;
    const std::string name = coverage_field(line, "f");
    const std::string place =
        name.substr(name.rfind('/') + 1) + ":" + coverage_field(line, "l") + " " + coverage_field(line, "o");
    counts[place] += std::stoull(line.substr(end + 2));
  }
  close(file);
  for (const auto& [place, count] : counts) point(user, place.c_str(), count);
  return 0;
}
#endif
