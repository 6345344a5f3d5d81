// SPDX-License-Identifier: Apache-2.0
#include "plugin/foreign_code.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>

namespace kage {
namespace {

constexpr std::size_t kMostText = 400;
constexpr std::size_t kMostMarks = 4;

// Data that a signal handler reads: so that it asks for no memory and waits for nothing.
struct Marks {
  std::array<std::array<char, kMostText + 1>, kMostMarks> texts{};
  std::size_t count = 0;
};
thread_local Marks marks;
int code_of_end = 1;

const char* signal_name(int number) {
  switch (number) {
    case SIGSEGV:
      return "SIGSEGV";
    case SIGABRT:
      return "SIGABRT";
    case SIGFPE:
      return "SIGFPE";
    default:
      return "SIGILL";
  }
}

void on_end(int number) {
  if (marks.count == 0 || marks.count > kMostMarks) {
    (void)std::signal(number, SIG_DFL);
    (void)raise(number);  // it ends the program now, as if nobody had caught it
    return;
  }
  const char* const what = marks.texts[marks.count - 1].data();
  for (const char* part : {"kage: ", what, ": ended by ", signal_name(number), ": a defect there, or no memory\n"})
    if (write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  _exit(code_of_end);
}

}  // namespace

ForeignCode::ForeignCode(std::string_view what) {
  if (marks.count < kMostMarks) {
    auto& text = marks.texts[marks.count];
    const std::size_t size = std::min(what.size(), kMostText);
    std::copy_n(what.begin(), size, text.begin());
    std::replace_if(
        text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size),
        [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    text[size] = '\0';
  }
  ++marks.count;
}

ForeignCode::~ForeignCode() { --marks.count; }

void tell_foreign_ends(int exit_code) {
  code_of_end = exit_code;
  // Where a stack has overflown there is no room for a handler: another one, of the thread that asks.
  static std::array<char, 1 << 16> room;
  stack_t stack{};
  stack.ss_sp = room.data();
  stack.ss_size = room.size();
  (void)sigaltstack(&stack, nullptr);
  struct sigaction action = {};
  action.sa_handler = on_end;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGILL}) sigaction(number, &action, nullptr);
}

}  // namespace kage
