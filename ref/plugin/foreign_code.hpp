// SPDX-License-Identifier: Apache-2.0
//
// Libraries that end by a signal where memory runs out, or where a file is not what they expect.
#pragma once

#include <string_view>

namespace kage {

/// Marks that this thread runs code that is not kage's, and says of it what a person should be told. Marks may lie
/// within each other; the innermost one counts. The text is kept as far as it has 400 bytes, on one line.
class ForeignCode {
 public:
  explicit ForeignCode(std::string_view what);
  ~ForeignCode();
  ForeignCode(const ForeignCode&) = delete;
  ForeignCode& operator=(const ForeignCode&) = delete;
};

/// From now on a signal that such code ends by (SIGSEGV, SIGABRT, SIGFPE, SIGILL) ends the program with the exit code
/// and one line on standard error, "kage: WHAT: ended by SIGNAL: ...". Elsewhere it ends the program as it always did.
void tell_foreign_ends(int exit_code);

}  // namespace kage
