// SPDX-License-Identifier: Apache-2.0
//
// Frames of docs/link.md as bytes of the line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kage::board {

/// Kinds of frames; rtl/board/include/kage_link.svh has the same numbers.
enum class FrameKind : std::uint8_t {
  poll = 0x00,        ///< asks for an ACK
  hello = 0x01,       ///< begins a session
  write = 0x02,       ///< words for an address and those behind it
  stream = 0x03,      ///< words for the stream
  read = 0x04,        ///< asks for words of an address and those behind it
  write_same = 0x12,  ///< words for one address
  ack = 0x80,         ///< of the board: what it has taken, and may be sent
  data = 0x81,        ///< of the board: the answer to a READ
};

inline constexpr std::uint8_t kFlag = 0x7E;    ///< stands before and behind a frame
inline constexpr std::uint8_t kEscape = 0x7D;  ///< stands before a byte of a frame that was inverted in bit 5
inline constexpr std::size_t kMostBody = 256;  ///< bytes of a body: kind, sequence, payload and CRC
inline constexpr std::size_t kMostWritten = 62, kMostStreamed = 63, kMostRead = 62;  ///< words of a frame

/// Flags of ACK and DATA.
inline constexpr std::uint8_t kFresh = 1, kAxiError = 2, kOverrun = 4, kDropped = 8;

struct Frame {
  FrameKind kind = FrameKind::poll;
  std::uint8_t sequence = 0;
  std::vector<std::uint8_t> payload;
};

/// The frame's bytes on the line, from flag to flag. The payload has 252 bytes at most.
std::vector<std::uint8_t> encoded(const Frame& frame);

/// Puts a number at the end of a payload, its lowest byte first.
void put_word(std::vector<std::uint8_t>& payload, std::uint32_t word);
/// The number at a place of a payload.
std::uint32_t word_at(std::span<const std::uint8_t> payload, std::size_t at);

/// Finds frames in bytes that came over a line.
class FrameReader {
 public:
  /// Takes a byte. Returns the frame that it ends, if that is whole; its kind may be none that there is.
  std::optional<Frame> take(std::uint8_t byte);
  /// How many bodies were no frame: damaged, too short or too long.
  [[nodiscard]] std::uint64_t damaged() const { return damaged_; }

 private:
  std::vector<std::uint8_t> body_;
  bool escaped_ = false;
  std::uint64_t damaged_ = 0;
};

}  // namespace kage::board
