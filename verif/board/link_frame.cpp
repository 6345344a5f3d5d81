// SPDX-License-Identifier: Apache-2.0
#include "board/link_frame.hpp"

#include <boost/crc.hpp>

#include "kage/error.hpp"

namespace kage::board {
namespace {

// CRC-16/X-25: the polynomial x^16 + x^12 + x^5 + 1, lowest bits first, from all ones, inverted at the end.
std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  boost::crc_optimal<16, 0x1021, 0xFFFF, 0xFFFF, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return static_cast<std::uint16_t>(crc.checksum());
}

}  // namespace

std::vector<std::uint8_t> encoded(const Frame& frame) {
  std::vector<std::uint8_t> body{static_cast<std::uint8_t>(frame.kind), frame.sequence};
  body.insert(body.end(), frame.payload.begin(), frame.payload.end());
  if (body.size() + 2 > kMostBody) throw Error("a frame of the link is longer than 256 bytes");
  const std::uint16_t crc = crc16(body);
  body.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  body.push_back(static_cast<std::uint8_t>(crc >> 8));
  std::vector<std::uint8_t> line{kFlag};
  line.reserve(body.size() + 8);
  for (const std::uint8_t byte : body) {
    const bool special = byte == kFlag || byte == kEscape;
    if (special) line.push_back(kEscape);
    line.push_back(special ? static_cast<std::uint8_t>(byte ^ 0x20) : byte);
  }
  line.push_back(kFlag);
  return line;
}

void put_word(std::vector<std::uint8_t>& payload, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) payload.push_back(static_cast<std::uint8_t>(word >> shift & 0xFF));
}

std::uint32_t word_at(std::span<const std::uint8_t> payload, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= static_cast<std::uint32_t>(payload[at + i]) << 8 * i;
  return word;
}

std::optional<Frame> FrameReader::take(std::uint8_t byte) {
  if (byte != kFlag) {
    if (byte == kEscape && !escaped_) {
      escaped_ = true;
      return std::nullopt;
    }
    // One byte more than a body may have is kept, so that its length is told to be wrong.
    if (body_.size() <= kMostBody) body_.push_back(escaped_ ? static_cast<std::uint8_t>(byte ^ 0x20) : byte);
    escaped_ = false;
    return std::nullopt;
  }
  std::vector<std::uint8_t> body;
  body.swap(body_);
  const bool cut = escaped_;
  escaped_ = false;
  if (body.empty() && !cut) return std::nullopt;
  const std::size_t size = body.size();
  if (cut || size < 4 || size > kMostBody ||
      crc16(std::span(body).first(size - 2)) != (body[size - 2] | body[size - 1] << 8)) {
    ++damaged_;
    return std::nullopt;
  }
  return Frame{static_cast<FrameKind>(body[0]), body[1], {body.begin() + 2, body.end() - 2}};
}

}  // namespace kage::board
