// SPDX-License-Identifier: Apache-2.0
#include "board/player.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <utility>

#include "board/generated/board_registers.h"
#include "kage/defs.hpp"
#include "kage/error.hpp"

namespace kage::board {
namespace {

/// Words between two calls of `wait`: some 14 ms at 3 Mbaud.
constexpr std::size_t kPiece = 1024;
/// Pieces of a load between two calls of state(): 1,100 frames of the link, which counts them modulo 2^16.
constexpr int kPiecesToCount = 64;

/// Greatest value of PLAYED and LINES.
constexpr std::uint32_t kMostCounted = 0xFFFF;

constexpr std::uint32_t kHold = KAGE_BOARD_CONTROL_HOLD_MASK;

std::string letters(std::uint32_t name) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    const char c = static_cast<char>(name >> shift & 0xFF);
    text += c >= '!' && c <= '~' ? c : '?';
  }
  return text;
}

}  // namespace

std::uint32_t crc_of(std::span<const std::uint32_t> words, std::uint32_t before) {
  uLong crc = before;
  for (const std::uint32_t word : words) {
    const std::array<Bytef, 4> bytes{static_cast<Bytef>(word & 0xFF), static_cast<Bytef>(word >> 8 & 0xFF),
                                     static_cast<Bytef>(word >> 16 & 0xFF), static_cast<Bytef>(word >> 24)};
    crc = crc32_z(crc, bytes.data(), bytes.size());
  }
  return static_cast<std::uint32_t>(crc);
}

Player::Player(Link& link, std::string port, std::function<void()> wait)
    : link_(link), port_(std::move(port)), wait_(std::move(wait)) {}

Identity Player::identify() {
  const std::vector<std::uint32_t> first = link_.read(KAGE_BOARD_ID, 2);
  if (first[0] != KAGE_BOARD_ID_VALUE)
    throw Error(
        fmt::format("{}: what answers has {:08x} as BOARD_ID and is no kage board: load a bitstream of tools/fpga",
                    port_, first[0]));
  if (first[1] != KAGE_BOARD_LAYOUT_VALUE)
    throw Error(
        fmt::format("{}: the board has layout {} of registers, and this kage knows {}: load a bitstream of this "
                    "kage's rtl, or take the kage that the bitstream was made with",
                    port_, first[1], KAGE_BOARD_LAYOUT_VALUE));
  const std::vector<std::uint32_t> board = link_.read(KAGE_BOARD_NAME, 4);
  Identity id;
  id.name = letters(board[0]);
  id.memory_words = board[1];
  id.lines = KAGE_FIELD(board[2], KAGE_BOARD_SIZES_LINES);
  id.pixels = KAGE_FIELD(board[2], KAGE_BOARD_SIZES_PIXELS);
  id.screen_width = KAGE_FIELD(board[3], KAGE_BOARD_SCREEN_WIDTH);
  id.screen_height = KAGE_FIELD(board[3], KAGE_BOARD_SCREEN_HEIGHT);
  restart();
  const std::vector<std::uint32_t> core = link_.read(KAGE_REG_ID, 4);
  id.core_id = core[0];
  id.version = core[1];
  id.param_hash = core[2];
  id.shape = core[3];
  if (id.core_id != KAGE_ID_VALUE)
    throw Error(
        fmt::format("{}: board {}: the core's ID is {:08x}, and kage's is {:08x}: load a bitstream of tools/fpga",
                    port_, id.name, id.core_id, KAGE_ID_VALUE));
  if (id.version != kStreamVersion)
    throw Error(
        fmt::format("{}: board {}: the core is of stream version {}, and this kage of {}: load a bitstream of this "
                    "kage's rtl",
                    port_, id.name, id.version, kStreamVersion));
  return id;
}

void Player::restart(std::uint32_t control) {
  set(KAGE_BOARD_CONTROL, kHold);
  set(KAGE_BOARD_CONTROL, control);
}

void Player::control(std::uint32_t bits) { set(KAGE_BOARD_CONTROL, bits); }

void Player::send(std::span<const std::uint32_t> words) {
  while (!words.empty()) {
    if (wait_) wait_();
    const auto piece = words.first(std::min(words.size(), kPiece));
    link_.stream(piece);
    words = words.subspan(piece.size());
  }
  link_.flush();
}

void Player::load(std::uint32_t address, std::span<const std::uint32_t> words) {
  const std::uint32_t wanted = crc_of(words);
  std::uint32_t got = 0;
  for (int tries = 0; tries < 2; ++tries) {
    set(KAGE_BOARD_LOAD_ADDRESS, address);
    for (std::size_t at = 0; at < words.size(); at += kPiecesToCount * kPiece) {
      send(words.subspan(at, std::min(words.size() - at, kPiecesToCount * kPiece)));
      (void)state();
    }
    got = get(KAGE_BOARD_LOAD_CRC);
    if (got == wanted) return;
  }
  throw Error(fmt::format(
      "{}: words reached the board damaged, twice: LOAD_CRC is {:08x} and must be {:08x}: the line damages bytes "
      "and the link's 16-bit check did not see it: use a shorter cable, no hub, or a lower baud rate",
      port_, got, wanted));
}

void Player::direct(std::span<const std::uint32_t> words) { send(words); }

void Player::start(std::uint32_t address) {
  set(KAGE_BOARD_PLAY_ADDRESS, address);
  set(KAGE_BOARD_COMMAND, KAGE_BOARD_COMMAND_START_MASK);
}

void Player::stop() { set(KAGE_BOARD_COMMAND, KAGE_BOARD_COMMAND_STOP_MASK); }

PlayState Player::state() {
  constexpr std::size_t words = (KAGE_BOARD_LINK_OVERRUNS - KAGE_BOARD_STATE) / 4 + 1;
  const std::vector<std::uint32_t> all = link_.read(KAGE_BOARD_STATE, words);
  const auto at = [&](std::uint32_t address) { return all.at((address - KAGE_BOARD_STATE) / 4); };
  PlayState s;
  s.playing = (all[0] & KAGE_BOARD_STATE_PLAYING_MASK) != 0;
  s.memory_ready = (all[0] & KAGE_BOARD_STATE_MEMORY_READY_MASK) != 0;
  s.play_crc = at(KAGE_BOARD_PLAY_CRC);
  s.played = at(KAGE_BOARD_PLAYED);
  s.lines = at(KAGE_BOARD_LINES);
  for (const auto& [name, count] : {std::pair{"PLAYED", s.played}, std::pair{"LINES", s.lines}})
    if (count > kMostCounted)
      throw Error(fmt::format("{}: {} reads {:#x}, and counts modulo 65536: load a bitstream of tools/fpga", port_,
                              name, count));
  count(std::span(all).last((KAGE_BOARD_LINK_OVERRUNS - KAGE_BOARD_FRAMES_SHOWN) / 4 + 1));
  return s;
}

void Player::count(std::span<const std::uint32_t> registers) {
  if (counted_.empty()) counted_.assign(registers.begin(), registers.end());
  const std::array sums{&counts_.screen.shown,          &counts_.screen.late, &counts_.screen.underrun_frames,
                        &counts_.screen.underrun_lines, &counts_.link_good,   &counts_.link_bad,
                        &counts_.link_overruns};
  for (std::size_t i = 0; i < sums.size(); ++i) *sums.at(i) += static_cast<std::uint16_t>(registers[i] - counted_[i]);
  counted_.assign(registers.begin(), registers.end());
}

void Player::set(std::uint32_t address, std::uint32_t value) { link_.write(address, std::span(&value, 1)); }

std::uint32_t Player::get(std::uint32_t address) { return link_.read(address, 1).front(); }

std::vector<std::uint32_t> Player::signatures(std::size_t lines) { return link_.read(KAGE_BOARD_SIGNATURES, lines); }

void Player::expect(std::span<const std::uint32_t> signatures) { link_.write(KAGE_BOARD_SIGNATURES, signatures); }

std::vector<std::uint32_t> Player::captured(std::uint32_t most, std::uint32_t& came) {
  came = get(KAGE_BOARD_CAPTURED);
  return link_.read(KAGE_BOARD_PIXELS, std::min({came, most, std::uint32_t{KAGE_BOARD_PIXELS_WORDS}}));
}

bool Player::leave_idle() noexcept {
  try {
    // Behind an error the link needs a greeting, which does no harm elsewhere.
    link_.hello();
    stop();
    set(KAGE_BOARD_CONTROL, kHold);
    link_.flush();
    return true;
  } catch (...) {
    return false;
  }
}

}  // namespace kage::board
