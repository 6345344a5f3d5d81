// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kage::board {

/// A line that carries bytes both ways, in order, and may lose or damage some: a serial port, or a model of a board.
/// Its clock counts microseconds from any moment on, and never goes back.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Sends bytes. May wait until the line has room for them; throws Error when the line is gone.
  virtual void write(std::span<const std::uint8_t> bytes) = 0;

  /// Takes bytes that came, as many as there are and fit, and returns their number. Waits for the first until
  /// `deadline` of the transport's clock, and returns 0 then; with a deadline that is over it does not wait. Throws
  /// Error when the line is gone.
  virtual std::size_t read(std::span<std::uint8_t> bytes, std::uint64_t deadline) = 0;

  /// The time, in microseconds.
  virtual std::uint64_t now() = 0;
};

}  // namespace kage::board
