// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "kage/error.hpp"

namespace kage::cosim {

/// A program could not be started: cause() is the errno of it, ENOENT where there is no such program.
class NotStarted : public Error {
 public:
  NotStarted(const std::string& program, int cause);
  [[nodiscard]] int cause() const { return cause_; }

 private:
  int cause_;
};

/// The words of a program that are kept: on standard output and standard error, or on standard output alone.
enum class Said : std::uint8_t { all, output };

/// A program in a process group of its own, with its words. It ends with the
/// object, and all programs of its group with it. If this process dies, however that may be, the program gets SIGTERM,
/// upon which it has to end its group.
class Process {
 public:
  /// Throws NotStarted, also where there is no such program.
  explicit Process(const std::vector<std::string>& command, Said kept = Said::all);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// True once it has ended, `ok` if it did so with exit status 0. To be asked now and then while it runs, as it waits
  /// where nobody reads what it says.
  bool ended(bool& ok);

  /// Its words so far.
  [[nodiscard]] const std::string& said() const { return said_; }

 private:
  void end();
  void read_output();

  pid_t pid_ = 0;
  int output_ = -1;
  std::string said_;
};

}  // namespace kage::cosim
