// SPDX-License-Identifier: Apache-2.0
#include "board/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/serial.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include "kage/error.hpp"

namespace kage::board {
namespace {

constexpr std::array<std::pair<int, speed_t>, 12> kRates{{{115200, B115200},
                                                          {230400, B230400},
                                                          {460800, B460800},
                                                          {500000, B500000},
                                                          {576000, B576000},
                                                          {921600, B921600},
                                                          {1000000, B1000000},
                                                          {1152000, B1152000},
                                                          {1500000, B1500000},
                                                          {2000000, B2000000},
                                                          {2500000, B2500000},
                                                          {3000000, B3000000}}};

// Repeats a system call that a signal interrupts.
template <class Call>
auto repeated(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

std::string text_of(int error) { return std::generic_category().message(error); }

std::string why_not_open(int error) {
  switch (error) {
    case ENOENT:
      return "no such device";
    case EACCES:
    case EPERM:
      return "permission denied: join the group dialout (sudo usermod -aG dialout $USER), and log in anew";
    case EBUSY:
      return "another program has it open";
    case ENXIO:
    case ENODEV:
      return "no such device: nothing is plugged in";
    default:
      return "cannot be opened: " + text_of(error);
  }
}

}  // namespace

std::vector<int> serial_rates() {
  std::vector<int> rates;
  for (const auto& [baud, speed] : kRates) rates.push_back(baud);
  return rates;
}

SerialPort::SerialPort(const std::string& device, int baud) : device_(device) {
  // Without O_NONBLOCK the opening of a port waits for its modem line.
  file_ = repeated([&] { return ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC); });
  if (file_ < 0) fail(why_not_open(errno));
  try {
    set_up(baud);
  } catch (...) {
    ::close(file_);
    throw;
  }
}

SerialPort::~SerialPort() {
  ::ioctl(file_, TIOCNXCL);
  ::close(file_);
}

void SerialPort::fail(const std::string& why) const { throw Error(device_ + ": " + why); }

void SerialPort::set_up(int baud) {
  if (::isatty(file_) == 0) fail("is not a terminal, so no serial port");
  const auto rate = std::find_if(kRates.begin(), kRates.end(), [&](const auto& r) { return r.first == baud; });
  if (rate == kRates.end())
    fail(fmt::format("{} baud is not possible; possible are {}", baud, fmt::join(serial_rates(), ", ")));
  if (::ioctl(file_, TIOCEXCL) != 0) fail("cannot be kept from other programs: " + text_of(errno));

  termios settings{};
  if (repeated([&] { return ::tcgetattr(file_, &settings); }) != 0) fail("has no settings: " + text_of(errno));
  ::cfmakeraw(&settings);
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS | PARENB | HUPCL | CSIZE);
  settings.c_cflag |= CS8 | CLOCAL | CREAD;
  settings.c_iflag &= ~static_cast<tcflag_t>(IXON | IXOFF | IXANY | INPCK);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  ::cfsetispeed(&settings, rate->second);
  ::cfsetospeed(&settings, rate->second);
  // tcsetattr succeeds if any of it could be set: what was set is read back.
  if (repeated([&] { return ::tcsetattr(file_, TCSANOW, &settings); }) != 0)
    fail(fmt::format("{} baud cannot be set: {}", baud, text_of(errno)));
  termios now_set{};
  if (repeated([&] { return ::tcgetattr(file_, &now_set); }) != 0) fail("has no settings: " + text_of(errno));
  if (::cfgetospeed(&now_set) != rate->second || ::cfgetispeed(&now_set) != rate->second)
    fail(fmt::format("{} baud is not possible on this port", baud));
  if ((now_set.c_cflag & (CSIZE | PARENB | CSTOPB | CRTSCTS)) != CS8) fail("cannot be set to 8N1 without flow control");
  // A USB bridge may keep bytes back for 16 ms to send more at once. Not every driver knows this, and all work without.
  serial_struct driver{};
  if (::ioctl(file_, TIOCGSERIAL, &driver) == 0) {
    driver.flags |= ASYNC_LOW_LATENCY;
    (void)::ioctl(file_, TIOCSSERIAL, &driver);
  }
  ::tcflush(file_, TCIOFLUSH);
}

void SerialPort::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = repeated([&] { return ::write(file_, bytes.data(), bytes.size()); });
    if (n > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
      continue;
    }
    if (n < 0 && errno != EAGAIN) fail("cannot be written: " + text_of(errno));
    // A line that takes nothing for ten seconds is held back by something: nothing here waits for ever.
    pollfd room{file_, POLLOUT, 0};
    const int ready = repeated([&] { return ::poll(&room, 1, 10'000); });
    if (ready == 0) fail("takes no bytes for 10 s");
    if (ready < 0 || (room.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) fail("is gone");
  }
}

std::size_t SerialPort::read(std::span<std::uint8_t> bytes, std::uint64_t deadline) {
  for (bool gone = false; true;) {
    const ssize_t n = repeated([&] { return ::read(file_, bytes.data(), bytes.size()); });
    if (n > 0) return static_cast<std::size_t>(n);
    if (gone || (n < 0 && errno == EIO)) fail("is gone");
    if (n < 0 && errno != EAGAIN) fail("cannot be read: " + text_of(errno));
    const std::uint64_t time = now();
    // Rounded up to poll's milliseconds; an hour at once, as the deadline may be beyond what poll takes.
    const std::uint64_t wait = deadline > time ? std::min<std::uint64_t>((deadline - time + 999) / 1000, 3'600'000) : 0;
    pollfd come{file_, POLLIN, 0};
    const int ready = ::poll(&come, 1, static_cast<int>(wait));
    if (ready < 0 && errno == EINTR) continue;  // with what is left of the time
    if (ready < 0) fail("cannot be waited for: " + text_of(errno));
    gone = (come.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;  // what had come before is read first
    if (ready == 0 && now() >= deadline) return 0;
  }
}

std::uint64_t SerialPort::now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(since).count());
}

}  // namespace kage::board
