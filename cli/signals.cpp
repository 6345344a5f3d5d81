// SPDX-License-Identifier: Apache-2.0
#include "signals.hpp"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace kage::cli {
namespace {

volatile std::sig_atomic_t signalled = 0;  // the number of the first signal
volatile std::sig_atomic_t at_once = 0;    // there is an EndsAtOnce

// The second signal ends the program wherever it waits, in destructors and exit handlers too. The next run removes the
// files that it leaves in hidden folders, and its children die with it.
void on_signal(int number) {
  if (signalled != 0) _exit(kSignalled + number);
  signalled = number;
  if (at_once == 0) return;
  constexpr std::string_view kText = "kage: interrupted\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
  _exit(kSignalled + number);
}

}  // namespace

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangup = {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup's wish stands
  // A reader that has gone away, and a file larger than ulimit -f allows, are errors of the write: what is half done is
  // tidied up.
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);
}

bool interrupted() { return signalled != 0; }

int interrupted_code() { return kSignalled + signalled; }

EndsAtOnce::EndsAtOnce() {
  at_once = 1;
  check_interrupt();  // one that came before
}

EndsAtOnce::~EndsAtOnce() { at_once = 0; }

void check_interrupt() {
  if (interrupted()) throw Interrupted{};
}

}  // namespace kage::cli
