// SPDX-License-Identifier: Apache-2.0
// A board of C++ (fake_board.hpp) behind a pseudo-terminal, for tests of the command line.
//
// usage: fake_board PACK [FAULT [N]]: prints the device's name, and is a board until it is ended. Its core has the
// pack's configuration. FAULT is one of
//    line N    line N since power-up has a wrong pixel whenever its pixels come again
//    once N    line N since power-up has a wrong pixel
//    hang N    the core hangs in frame N
//    back N    the core hangs in frame N, and LINES goes back by one now and then
//    reset N   the board is reset at the link's frame N
//    hash      the core has another PARAM_HASH
//    screen    none: it has a screen, for which a line of each frame is too late
//    memory N  word N of the memory is read wrong
//    silent N  the memory gives no word from N on
#include "test/support/fake_board.hpp"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "vectors/check.hpp"

namespace {

void spoil(kage::test::FakeBoard& board, const std::string& fault, std::uint64_t n) {
  if (fault == "line")
    board.spoil = [n, wrong = std::vector<std::uint8_t>()](std::uint64_t at, std::span<std::uint8_t> pixels) mutable {
      if (at == n) wrong.assign(pixels.begin(), pixels.end());
      if (!wrong.empty() && std::equal(pixels.begin(), pixels.end(), wrong.begin(), wrong.end())) pixels.back() ^= 0x20;
    };
  else if (fault == "once")
    board.spoil = [n](std::uint64_t at, std::span<std::uint8_t> pixels) {
      if (at == n) pixels.back() ^= 0x20;
    };
  else if (fault == "hang")
    board.hangs_in = n;
  else if (fault == "back") {
    board.hangs_in = n;
    board.board_says = [reads = 0](std::uint32_t address, std::uint32_t value) mutable {
      return address == KAGE_BOARD_LINES && value > 0 ? value - static_cast<std::uint32_t>(reads++ / 9 % 2) : value;
    };
  } else if (fault == "reset")
    board.resets_at = n;
  else if (fault == "hash")
    board.other_hash = 1;
  else if (fault == "memory")
    board.memory_gives = [n](std::uint32_t address, std::uint32_t word) { return address == n ? word ^ 1U : word; };
  else if (fault == "silent")
    board.memory_ends = [n](std::uint32_t address) { return address >= n; };
  else if (fault == "screen")
    board.screen = 640 | 480U << 16U, board.underruns = 1;
}

int open_terminal() {
  const int file = posix_openpt(O_RDWR | O_NOCTTY);
  if (file < 0 || grantpt(file) != 0 || unlockpt(file) != 0) return -1;
  // While nobody has the other end open, reading is no error: this keeps it open.
  const int other = open(ptsname(file), O_RDWR | O_NOCTTY);
  termios settings{};
  if (other < 0 || tcgetattr(other, &settings) != 0) return -1;
  cfmakeraw(&settings);
  return tcsetattr(other, TCSANOW, &settings) == 0 ? file : -1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const kage::vectors::Pack pack = kage::vectors::checked_pack(argv[1], kage::vectors::Check::answers, [] {});
  kage::test::FakeBoard board(pack.config);
  if (argc > 2) spoil(board, argv[2], argc > 3 ? std::stoull(argv[3]) : 0);
  const int file = open_terminal();
  if (file < 0) return 2;
  std::printf("%s\n", ptsname(file));
  std::fflush(stdout);
  std::vector<std::uint8_t> bytes(4096);
  while (true) {
    pollfd come{file, POLLIN, 0};
    (void)poll(&come, 1, -1);
    const ssize_t n = read(file, bytes.data(), bytes.size());
    if (n <= 0) return 0;
    board.write(std::span(bytes).first(static_cast<std::size_t>(n)));
    std::vector<std::uint8_t> answer(4096);
    while (const std::size_t out = board.read(answer, 0))
      for (std::size_t at = 0; at < out;) {
        const ssize_t written = write(file, answer.data() + at, out - at);
        if (written <= 0) return 0;
        at += static_cast<std::size_t>(written);
      }
  }
}
