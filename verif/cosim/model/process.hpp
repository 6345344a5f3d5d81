// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace kage::cosim {

/// A program in a process group of its own, with what it says on standard output and standard error. It ends with the
/// object, and all programs of its group with it. If this process dies, however that may be, the program gets SIGTERM,
/// upon which it has to end its group.
class Process {
 public:
  /// Throws Error if it cannot be started.
  explicit Process(const std::vector<std::string>& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// True once it has ended, `ok` if it did so with exit status 0. To be asked now and then while it runs, as it waits
  /// where nobody reads what it says.
  bool ended(bool& ok);

  /// What it has said so far.
  [[nodiscard]] const std::string& said() const { return said_; }

 private:
  void end();
  void read_output();

  pid_t pid_ = 0;
  int output_ = -1;
  std::string said_;
};

}  // namespace kage::cosim
