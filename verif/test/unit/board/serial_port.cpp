// SPDX-License-Identifier: Apache-2.0
// The serial port by a pseudo-terminal: bytes of every value both ways, deadlines, signals, and one line for each
// error.
#include "board/serial_port.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "kage/error.hpp"
#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"

using namespace kage;
using kage::board::SerialPort;

namespace {

/// The other end of a port.
class PseudoTerminal {
 public:
  PseudoTerminal() : file_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    REQUIRE(file_ >= 0);
    REQUIRE(::grantpt(file_) == 0);
    REQUIRE(::unlockpt(file_) == 0);
    device = ::ptsname(file_);
  }
  ~PseudoTerminal() { close(); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;
  void close() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }
  void write(const std::vector<std::uint8_t>& bytes) const {
    REQUIRE(::write(file_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
  std::vector<std::uint8_t> read(std::size_t count) const {
    std::vector<std::uint8_t> bytes(count);
    for (std::size_t n = 0; n < count;) {
      const ssize_t more = ::read(file_, bytes.data() + n, count - n);
      REQUIRE(more > 0);
      n += static_cast<std::size_t>(more);
    }
    return bytes;
  }
  [[nodiscard]] int file() const { return file_; }

  std::string device;

 private:
  int file_;
};

std::vector<std::uint8_t> all_bytes() {
  std::vector<std::uint8_t> bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

std::vector<std::uint8_t> read_all(SerialPort& port, std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  std::size_t n = 0;
  const std::uint64_t deadline = port.now() + 5'000'000;
  while (n < count && port.now() < deadline) n += port.read(std::span(bytes).subspan(n), deadline);
  bytes.resize(n);
  return bytes;
}

std::string error_of(const std::string& device, int baud) {
  try {
    SerialPort port(device, baud);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("every byte passes, both ways, at every rate") {
  REQUIRE(board::serial_rates().front() == 115200);
  REQUIRE(board::serial_rates().back() == 3000000);
  for (const int baud : board::serial_rates()) {
    PseudoTerminal other;
    SerialPort port(other.device, baud);
    other.write(all_bytes());
    CHECK(read_all(port, 256) == all_bytes());
    port.write(all_bytes());
    CHECK(other.read(256) == all_bytes());
    termios settings{};
    REQUIRE(::tcgetattr(other.file(), &settings) == 0);
    CHECK((settings.c_cflag & (CSIZE | CSTOPB | CRTSCTS)) == CS8);
    CHECK((settings.c_iflag & (IXON | IXOFF | ICRNL | ISTRIP)) == 0);
    CHECK((settings.c_lflag & (ICANON | ECHO | ISIG)) == 0);
    CHECK((settings.c_oflag & OPOST) == 0);
  }
}

TEST_CASE("what had come before the port was opened is forgotten") {
  PseudoTerminal other;
  const int early = ::open(other.device.c_str(), O_RDWR | O_NOCTTY);
  REQUIRE(early >= 0);
  termios settings{};
  REQUIRE(::tcgetattr(early, &settings) == 0);
  ::cfmakeraw(&settings);
  REQUIRE(::tcsetattr(early, TCSANOW, &settings) == 0);
  other.write({1, 2, 3});
  SerialPort port(other.device, 115200);
  other.write({4});
  CHECK(read_all(port, 1) == std::vector<std::uint8_t>{4});
  ::close(early);
}

TEST_CASE("a read waits until its deadline, and not beyond, though signals come") {
  PseudoTerminal other;
  SerialPort port(other.device, 3000000);
  struct sigaction action {};
  action.sa_handler = [](int) {};  // without SA_RESTART: calls are interrupted
  REQUIRE(::sigaction(SIGALRM, &action, nullptr) == 0);
  const itimerval often{{0, 2000}, {0, 2000}};
  REQUIRE(::setitimer(ITIMER_REAL, &often, nullptr) == 0);
  std::uint8_t byte = 0;
  const std::uint64_t begun = port.now();
  const std::size_t n = port.read({&byte, 1}, begun + 50'000);
  const std::uint64_t waited = port.now() - begun;
  // A long write is interrupted as well: the other end takes nothing for a while.
  const std::vector<std::uint8_t> much(100'000, 0x7E);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::vector<std::uint8_t> some(1000);
    std::size_t sum = 0;
    while (sum < much.size()) {
      ::usleep(500);
      const ssize_t more = ::read(other.file(), some.data(), some.size());
      if (more > 0) sum += static_cast<std::size_t>(more);
      if (more < 0 && errno != EINTR) break;
    }
    ::_exit(sum == much.size() ? 0 : 1);
  }
  port.write(much);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) CHECK(errno == EINTR);
  const itimerval never{};
  REQUIRE(::setitimer(ITIMER_REAL, &never, nullptr) == 0);
  CHECK(status == 0);
  CHECK(n == 0);
  CHECK(waited >= 50'000);
  CHECK(waited < 5'000'000);  // an upper bound for a loaded machine
  CHECK(port.read({&byte, 1}, 0) == 0);
}

TEST_CASE("errors are of one line, and name device and cause") {
  const test::TempDirectory folder;
  using Catch::Matchers::ContainsSubstring;
  const auto one_line = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n') == 0; };
  const std::string none = (folder.path() / "ttyUSB7").string();
  CHECK(error_of(none, 115200) == none + ": no such device");
  const std::string file = (folder.path() / "file").string();
  std::ofstream(file) << "text";
  CHECK(error_of(file, 115200) == file + ": is not a terminal, so no serial port");
  PseudoTerminal other;
  for (const int baud : {0, 9600, 115201, 4000000}) {
    const std::string text = error_of(other.device, baud);
    CHECK_THAT(text, ContainsSubstring(other.device + ": " + std::to_string(baud) + " baud is not possible"));
    CHECK_THAT(text, ContainsSubstring("921600"));
    CHECK(one_line(text));
  }
  if (::geteuid() != 0) {
    const std::string shut = (folder.path() / "shut").string();
    std::ofstream(shut) << "text";
    REQUIRE(::chmod(shut.c_str(), 0) == 0);
    CHECK_THAT(error_of(shut, 115200), ContainsSubstring("group dialout"));
  }
}

TEST_CASE("a port is one program's, and may be opened anew") {
  PseudoTerminal other;
  const int watch = ::open(other.device.c_str(), O_RDWR | O_NOCTTY);
  REQUIRE(watch >= 0);
  const auto exclusive = [&] {
    int on = -1;
    REQUIRE(::ioctl(watch, TIOCGEXCL, &on) == 0);
    return on;
  };
  CHECK(exclusive() == 0);
  {
    SerialPort port(other.device, 921600);
    CHECK(exclusive() == 1);  // root opens it all the same: what keeps others out is this
  }
  CHECK(exclusive() == 0);
  ::close(watch);
  CHECK_NOTHROW(SerialPort(other.device, 115200));
}

TEST_CASE("a port whose other end goes says so") {
  PseudoTerminal other;
  SerialPort port(other.device, 115200);
  other.close();
  std::uint8_t byte = 0;
  CHECK_THROWS_AS(port.read({&byte, 1}, port.now() + 1'000'000), Error);
}
