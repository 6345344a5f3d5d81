// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "board/transport.hpp"

namespace kage::board {

/// The rates from 115200 to 3000000 baud that this system has by name, rising.
std::vector<int> serial_rates();

/// A serial port: raw bytes, 8N1, no flow control. Nobody else opens it meanwhile (TIOCEXCL; root may).
class SerialPort : public Transport {
 public:
  /// Opens a device, as /dev/ttyUSB1, and forgets what had come. Throws Error of one line that names the device.
  SerialPort(const std::string& device, int baud);
  ~SerialPort() override;

  void write(std::span<const std::uint8_t> bytes) override;
  std::size_t read(std::span<std::uint8_t> bytes, std::uint64_t deadline) override;
  std::uint64_t now() override;

 private:
  [[noreturn]] void fail(const std::string& why) const;
  void set_up(int baud);

  std::string device_;
  int file_ = -1;
};

}  // namespace kage::board
