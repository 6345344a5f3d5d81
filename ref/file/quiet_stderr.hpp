// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kage {

/// While one lives, standard error of the whole program leads nowhere: for libraries that print what the program says
/// in words of its own.
class QuietStderr {
 public:
  QuietStderr();
  ~QuietStderr();
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

 private:
  int kept_;  // where standard error led before: a descriptor, or -1 where there is none left for it
};

}  // namespace kage
