// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "standard_files.hpp"

namespace kage::cli {

Progress::Progress() {
  const char* term = std::getenv("TERM");
  terminal_ = isatty(STDERR_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
  const char* const seconds = std::getenv("KAGE_PROGRESS");
  if (seconds == nullptr) return;
  double value = 0;
  const char* const end = seconds + std::strlen(seconds);
  const auto [stop, error] = std::from_chars(seconds, end, value);
  if (error == std::errc{} && stop == end && value >= 0 && value < 1e9) pause_ = std::chrono::duration<double>(value);
}

Progress::~Progress() { clear(); }

void Progress::show(const std::string& text) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_) {
    if (pause_.count() == 0 || now - last_ < pause_) return;
    last_ = now;
    say(text + "\n");
    return;
  }
  if (shown_ && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  shown_ = true;
  winsize window{};
  const std::size_t columns =
      ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1 ? window.ws_col - 1U : 79U;
  say("\r\033[K" + text.substr(0, columns));
}

void Progress::clear() {
  if (!shown_) return;
  say("\r\033[K");
  shown_ = false;
}

}  // namespace kage::cli
