// SPDX-License-Identifier: Apache-2.0
//
// The end of a run by Ctrl-C and its like.
#pragma once

#include "kage/cosim.hpp"

namespace kage::cli {

inline constexpr int kSignalled = 128;  // an exit code after a signal is this and its number, as shells have it

/// Ctrl-C (SIGINT), SIGTERM and SIGHUP set a flag; loops ask it, so that files are whole or absent. A second one ends
/// the program at once. A pipe without reader and a file that is too large are errors of the write.
void catch_signals();
bool interrupted();

/// The exit code after such a signal: 130 for SIGINT, 143 for SIGTERM, 129 for SIGHUP.
int interrupted_code();

/// While one is there nothing is half done, and the first signal ends the program at once: for work that asks no flag
/// and writes nothing.
class EndsAtOnce {
 public:
  /// Throws Interrupted if a signal has come already.
  EndsAtOnce();
  ~EndsAtOnce();
  EndsAtOnce(const EndsAtOnce&) = delete;
  EndsAtOnce& operator=(const EndsAtOnce&) = delete;
};

using cosim::Interrupted;

/// Throws Interrupted if the flag is set.
void check_interrupt();

}  // namespace kage::cli
