// SPDX-License-Identifier: Apache-2.0
//
// A board as a host sees it, without RTL: the other end of the link, the registers of rtl/defs/board.yaml, memory and
// player by the contracts of rtl/board, and the golden core in the core's place. Tests may inject faults into it.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "board/generated/board_registers.h"
#include "board/link_frame.hpp"
#include "board/transport.hpp"
#include "kage/core.hpp"
#include "kage/defs.hpp"
#include "vectors/pack.hpp"

namespace kage::test {

class FakeBoard : public board::Transport {
 public:
  explicit FakeBoard(const Config& config) : config_(config), golden_(config) { reset(); }

  // ---- what the board is; to be set before it is asked ----
  std::uint32_t name = 0x46414B45;  // "FAKE"
  std::uint32_t layout = KAGE_BOARD_LAYOUT_VALUE;
  std::uint32_t memory_words = 1U << 16U;
  std::uint32_t kept_lines = 512;
  std::uint32_t kept_pixels = 640;
  std::uint32_t screen = 0;  ///< of SCREEN

  // ---- what is wrong with it ----
  bool silent = false;                                                     ///< says nothing
  std::function<void(std::uint64_t line, std::span<std::uint8_t>)> spoil;  ///< the pixels of a line since power-up
  std::function<std::uint32_t(std::uint32_t address, std::uint32_t word)> memory_gives;  ///< what is read of the memory
  std::function<std::uint32_t(std::uint64_t number, std::uint32_t word)> arrives;  ///< at the memory, since power-up
  std::function<bool(std::uint8_t&)> to_board, to_host;    ///< a byte of the line; false: it is lost
  std::optional<std::uint64_t> hangs_in;                   ///< frame since the core's reset
  std::function<bool(std::uint32_t address)> memory_ends;  ///< true: from that read on the memory gives no word
  std::optional<std::uint64_t> resets_at;                  ///< frame of the link since power-up
  std::optional<std::uint32_t> other_hash;                 ///< PARAM_HASH
  std::function<std::uint32_t(std::uint32_t address, std::uint32_t value)> core_says;   ///< of the core's registers
  std::function<std::uint32_t(std::uint32_t address, std::uint32_t value)> board_says;  ///< of its own registers
  std::uint32_t underruns = 0;       ///< lines that run short in each frame that is shown
  std::uint32_t counted_before = 0;  ///< what the counters of screen and link stand at when it is powered up

  // ---- what a test looks at ----
  [[nodiscard]] bool held() const { return (control_ & KAGE_BOARD_CONTROL_HOLD_MASK) != 0; }
  [[nodiscard]] bool playing() const { return playing_; }
  [[nodiscard]] std::uint32_t control() const { return control_; }
  [[nodiscard]] std::uint64_t starts() const { return starts_; }
  [[nodiscard]] std::uint64_t lines_ever() const { return all_lines_; }
  [[nodiscard]] std::uint64_t core_resets() const { return core_resets_; }

  // ---- the line ----
  void write(std::span<const std::uint8_t> bytes) override {
    for (std::uint8_t byte : bytes) {
      time_ += 3;
      if (silent || (to_board && !to_board(byte))) continue;
      if (const auto frame = reader_.take(byte)) take(*frame);
      const std::uint64_t bad = reader_.damaged();
      if (bad != bad_) {
        bad_ = bad;
        dropped_ = true;
        ack();
      }
    }
  }
  std::size_t read(std::span<std::uint8_t> bytes, std::uint64_t deadline) override {
    std::size_t n = 0;
    for (; n < bytes.size() && !out_.empty(); ++n) {
      bytes[n] = out_.front();
      out_.pop_front();
    }
    if (n == 0) time_ = std::max(time_, deadline);
    time_ += 3 * n;
    return n;
  }
  std::uint64_t now() override { return time_; }

 private:
  static constexpr std::size_t kSlots = 4;

  // ---- the link ----
  void reset() {
    expected_ = session_ = done_ = 0;
    fresh_ = true;
    axi_error_ = dropped_ = false;
    kept_.clear();
    memory_.clear();
    signatures_.fill(0);
    pixels_.fill(0);
    registers_.clear();
    control_ = KAGE_BOARD_CONTROL_HOLD_MASK;
    reset_core();
    ack();
  }
  void say(const board::Frame& frame) {
    if (silent) return;
    for (std::uint8_t byte : board::encoded(frame))
      if (!to_host || to_host(byte)) out_.push_back(byte);
  }
  void ack() {
    const auto limit = static_cast<std::uint8_t>(expected_ + kSlots - kept_.size());
    const auto flags = static_cast<std::uint8_t>((fresh_ ? board::kFresh : 0) | (axi_error_ ? board::kAxiError : 0) |
                                                 (dropped_ ? board::kDropped : 0));
    say({board::FrameKind::ack, expected_, {limit, done_, session_, flags}});
    dropped_ = false;
  }
  void take(const board::Frame& frame) {
    using board::FrameKind;
    ++good_;
    if (resets_at && good_ == *resets_at) {
      reset();
      return;
    }
    if (frame.kind == FrameKind::hello) {
      session_ = frame.sequence;
      expected_ = static_cast<std::uint8_t>(frame.sequence + 1);
      done_ = static_cast<std::uint8_t>(expected_ - kept_.size());
      fresh_ = axi_error_ = dropped_ = false;
    } else if (frame.kind != FrameKind::poll) {
      const auto behind = static_cast<std::uint8_t>(expected_ - frame.sequence);
      if (fresh_ || frame.sequence != expected_ || kept_.size() >= kSlots) {
        dropped_ = fresh_ || behind > 128;
      } else {
        kept_.push_back(frame);
        ++expected_;
        dropped_ = false;
      }
    }
    execute();
    ack();
  }
  void execute() {
    while (!kept_.empty() && !stuck_) {
      const board::Frame frame = kept_.front();
      if (!does(frame)) {
        stuck_ = true;  // the stream's taker takes nothing
        return;
      }
      kept_.pop_front();
      ++done_;
    }
  }
  bool does(const board::Frame& frame) {
    using board::FrameKind;
    if (frame.kind == FrameKind::stream) {
      for (std::size_t at = 0; at < frame.payload.size(); at += 4)
        if (!stream(board::word_at(frame.payload, at))) return false;
      return true;
    }
    std::uint32_t address = board::word_at(frame.payload, 0);
    if (frame.kind == FrameKind::read) {
      step();
      std::vector<std::uint8_t> answer;
      for (std::uint8_t i = 0; i < frame.payload[4]; ++i, address += 4) board::put_word(answer, get(address));
      answer.push_back(axi_error_ ? board::kAxiError : std::uint8_t{0});
      say({FrameKind::data, frame.sequence, answer});
      return true;
    }
    for (std::size_t at = 4; at < frame.payload.size(); at += 4) {
      set(address, board::word_at(frame.payload, at));
      if (frame.kind == FrameKind::write) address += 4;
    }
    return true;
  }

  // ---- registers ----
  std::uint32_t get(std::uint32_t address) {
    if (address < KAGE_BOARD_ID) return core(address);
    const std::uint32_t value = own(address);
    return board_says ? board_says(address, value) : value;
  }
  std::uint32_t own(std::uint32_t address) {
    if (address >= KAGE_BOARD_PIXELS && address < KAGE_BOARD_PIXELS + 4 * KAGE_BOARD_PIXELS_WORDS)
      return pixels_.at((address - KAGE_BOARD_PIXELS) / 4);
    if (address >= KAGE_BOARD_SIGNATURES && address < KAGE_BOARD_SIGNATURES + 4 * KAGE_BOARD_SIGNATURES_WORDS)
      return signatures_.at((address - KAGE_BOARD_SIGNATURES) / 4);
    switch (address) {
      case KAGE_BOARD_ID:
        return KAGE_BOARD_ID_VALUE;
      case KAGE_BOARD_LAYOUT:
        return layout;
      case KAGE_BOARD_NAME:
        return name;
      case KAGE_BOARD_MEMORY_WORDS:
        return memory_words;
      case KAGE_BOARD_SIZES:
        return kept_lines | kept_pixels << 16U;
      case KAGE_BOARD_SCREEN:
        return screen;
      case KAGE_BOARD_CONTROL:
        return control_;
      case KAGE_BOARD_STATE:
        return KAGE_BOARD_STATE_MEMORY_READY_MASK | (playing_ ? KAGE_BOARD_STATE_PLAYING_MASK : 0);
      case KAGE_BOARD_LOAD_CRC:
      case KAGE_BOARD_PLAY_CRC:
        return words_crc_;
      case KAGE_BOARD_PLAYED:
        return played_ & 0xFFFFU;
      case KAGE_BOARD_LINES:
        return lines_ & 0xFFFFU;
      case KAGE_BOARD_MISMATCHES:
        return std::min(mismatches_, 0xFFFFU);
      case KAGE_BOARD_MISMATCH_LINE:
        return mismatch_line_;
      case KAGE_BOARD_CAPTURED:
        return captured_;
      case KAGE_BOARD_FRAMES_SHOWN:
        return (counted_before + shown_) & 0xFFFFU;
      case KAGE_BOARD_UNDERRUN_FRAMES:
        return (counted_before + (underruns == 0 ? 0 : shown_)) & 0xFFFFU;
      case KAGE_BOARD_UNDERRUN_LINES:
        return (counted_before + underruns * shown_) & 0xFFFFU;
      case KAGE_BOARD_LINK_GOOD:
        return (counted_before + static_cast<std::uint32_t>(good_)) & 0xFFFFU;
      case KAGE_BOARD_LINK_BAD:
        return (counted_before + static_cast<std::uint32_t>(bad_)) & 0xFFFFU;
      default:
        return registers_[address];
    }
  }
  void set(std::uint32_t address, std::uint32_t value) {
    if (address >= KAGE_BOARD_SIGNATURES && address < KAGE_BOARD_SIGNATURES + 4 * KAGE_BOARD_SIGNATURES_WORDS) {
      signatures_.at((address - KAGE_BOARD_SIGNATURES) / 4) = value;
      return;
    }
    registers_[address] = value;
    if (address == KAGE_BOARD_CONTROL) {
      control_ = value;
      if (held()) reset_core();
    } else if (address == KAGE_BOARD_LOAD_ADDRESS) {
      load_at_ = value;
      words_crc_ = 0;
    } else if (address == KAGE_BOARD_COMMAND && !held()) {
      if ((value & KAGE_BOARD_COMMAND_STOP_MASK) != 0) stop();
      if ((value & KAGE_BOARD_COMMAND_START_MASK) != 0 && !playing_) start();
    }
  }
  std::uint32_t core(std::uint32_t address) {
    if (held()) {
      axi_error_ = true;
      return 0;
    }
    // The value that the pack has for such frames; a fault may change it.
    std::uint32_t value = 0;
    const std::vector<vectors::RegisterRead> reads = vectors::register_reads(config_, ended_);
    for (const vectors::RegisterRead& r : reads)
      if (r.address == address) value = r.value;
    if (ended_.empty()) {
      for (const vectors::RegisterRead& r : vectors::register_reads(config_, std::span(&settled_, 1)))
        if (r.address == address && address <= KAGE_REG_SHAPE) value = r.value;
    }
    if (address == KAGE_REG_PARAM_HASH && other_hash) value = *other_hash;
    if (address == KAGE_REG_STATUS && hung_) value = KAGE_STATUS_OPEN_MASK;
    if (address == KAGE_REG_STATUS && !hung_ && !frame_words_.empty())
      value = KAGE_STATUS_OPEN_MASK | KAGE_STATUS_WAITING_INPUT_MASK;
    return core_says ? core_says(address, value) : value;
  }

  // ---- memory and player ----
  bool stream(std::uint32_t word) {
    if ((control_ & KAGE_BOARD_CONTROL_DIRECT_MASK) != 0) return direct(word);
    if (arrives) word = arrives(arrived_, word);
    ++arrived_;
    memory_[load_at_ % memory_words] = word;
    ++load_at_;
    words_crc_ = crc(words_crc_, word);
    return true;
  }
  static std::uint32_t crc(std::uint32_t before, std::uint32_t word) {
    std::array<std::uint8_t, 4> bytes{};
    for (std::size_t i = 0; i < 4; ++i) bytes.at(i) = static_cast<std::uint8_t>(word >> (8 * i));
    return static_cast<std::uint32_t>(crc32_z(before, bytes.data(), bytes.size()));
  }
  void reset_core() {
    ++core_resets_;
    playing_ = hung_ = stuck_ = starved_ = false;
    ended_.clear();
    frame_words_.clear();
    left_ = 0;
    lines_ = mismatches_ = mismatch_line_ = captured_ = played_ = 0;
    golden_ = GoldenCore(config_);
  }
  void start() {
    ++starts_;
    lines_ = mismatches_ = mismatch_line_ = captured_ = played_ = words_crc_ = 0;
    playing_ = true;
    left_ = 0;
    at_ = registers_[KAGE_BOARD_PLAY_ADDRESS];
    if ((control_ & (KAGE_BOARD_CONTROL_LOOP_MASK | KAGE_BOARD_CONTROL_DIRECT_MASK)) == 0)
      while (playing_ && !hung_ && !starved_) play_frame();
  }
  void stop() {
    if (!hung_ && !starved_) playing_ = false;
  }
  /// Stands for the passing of time: a list that is played over and over goes on whenever the host looks.
  void step() {
    if ((control_ & KAGE_BOARD_CONTROL_LOOP_MASK) == 0) return;
    for (int i = 0; i < 7 && playing_ && !hung_ && !starved_; ++i) play_frame();
  }
  /// Nothing where the memory gives no word.
  std::optional<std::uint32_t> memory_word() {
    starved_ = starved_ || (memory_ends && memory_ends(at_ % memory_words));
    if (starved_) return std::nullopt;
    const std::uint32_t word = memory_[at_ % memory_words];
    return memory_gives ? memory_gives(at_++ % memory_words, word) : (++at_, word);
  }
  void play_frame() {
    const std::optional<std::uint32_t> count = memory_word();
    if (!count) return;
    if (*count == 0) {
      at_ = registers_[KAGE_BOARD_PLAY_ADDRESS];
      if ((control_ & KAGE_BOARD_CONTROL_LOOP_MASK) == 0) playing_ = false;
      return;
    }
    for (std::uint32_t i = 0; i < *count; ++i) {
      const std::optional<std::uint32_t> word = memory_word();
      if (!word) return;
      take_word(*word);
    }
    draw();
  }
  bool direct(std::uint32_t word) {
    if (!playing_ || hung_) return false;
    if (left_ == 0) {
      left_ = word;
      playing_ = word != 0;
      return true;
    }
    take_word(word);
    if (--left_ == 0) draw();
    return !hung_;
  }
  void take_word(std::uint32_t word) {
    frame_words_.push_back(word);
    words_crc_ = crc(words_crc_, word);
  }
  void draw() {
    const std::vector<std::uint32_t> words = std::exchange(frame_words_, {});
    const bool hangs = hangs_in && *hangs_in == ended_.size();
    int last = -1;
    std::vector<std::vector<std::uint8_t>> rows;
    vectors::PackFrame f;
    f.status = golden_.frame(words, [&](int y, std::span<const std::uint8_t> row) {
      rows.emplace_back(row.begin(), row.end());
      last = y;
    });
    if (hangs) {
      hung_ = true;
      rows.resize(std::min<std::size_t>(rows.size(), 1));
    }
    const auto width = static_cast<std::size_t>(f.status.width);
    for (std::size_t y = 0; y < rows.size(); ++y) line(rows[y], width, y == 0);
    if (hangs) return;
    if (!rows.empty()) ++shown_;
    f.settles = true;
    ended_.push_back(f);
    ++played_;
  }
  void line(std::span<std::uint8_t> row, std::size_t width, bool first) {
    if (spoil) spoil(all_lines_, row);
    ++all_lines_;
    vectors::LineSignature signature;
    const auto channels = static_cast<std::size_t>(config_.channels);
    const bool chosen = registers_[KAGE_BOARD_CAPTURE_LINE] == lines_;
    for (std::size_t x = 0; x < width; ++x) {
      const bool user = first && x == 0;
      const bool last = x + 1 == width;
      signature.pixel(row.subspan(x * channels, channels), user, last);
      if (!chosen) continue;
      std::uint32_t pixel = (user ? KAGE_BOARD_PIXELS_USER_MASK : 0) | (last ? KAGE_BOARD_PIXELS_LAST_MASK : 0);
      for (std::size_t c = 0; c < channels; ++c) pixel |= static_cast<std::uint32_t>(row[x * channels + c]) << (8 * c);
      if (captured_ < kept_pixels) pixels_.at(captured_) = pixel;
      ++captured_;
    }
    const std::uint32_t wrap = registers_[KAGE_BOARD_LOOP_LINES];
    const std::uint32_t place = wrap == 0 ? lines_ : lines_ % wrap;
    ++lines_;
    if (place >= kept_lines) return;
    if ((control_ & KAGE_BOARD_CONTROL_CHECK_MASK) == 0) {
      signatures_.at(place) = signature.value();
    } else if (signatures_.at(place) != signature.value()) {
      if (mismatches_ == 0) mismatch_line_ = place;
      ++mismatches_;
    }
  }

  Config config_;
  GoldenCore golden_;
  std::uint64_t time_ = 0;
  board::FrameReader reader_;
  std::deque<std::uint8_t> out_;
  std::uint8_t expected_ = 0, session_ = 0, done_ = 0;
  bool fresh_ = true, axi_error_ = false, dropped_ = false, stuck_ = false;
  std::deque<board::Frame> kept_;
  std::uint64_t good_ = 0, bad_ = 0;

  std::map<std::uint32_t, std::uint32_t> registers_, memory_;
  std::uint32_t control_ = 0, load_at_ = 0, words_crc_ = 0, at_ = 0, left_ = 0;
  std::uint32_t played_ = 0, lines_ = 0, mismatches_ = 0, mismatch_line_ = 0, captured_ = 0, shown_ = 0;
  bool playing_ = false, hung_ = false, starved_ = false;
  std::vector<std::uint32_t> frame_words_;
  std::vector<vectors::PackFrame> ended_;
  vectors::PackFrame settled_ = [] {
    vectors::PackFrame f;
    f.settles = true;
    return f;
  }();
  std::array<std::uint32_t, KAGE_BOARD_SIGNATURES_WORDS> signatures_{};
  std::array<std::uint32_t, KAGE_BOARD_PIXELS_WORDS> pixels_{};
  std::uint64_t arrived_ = 0, all_lines_ = 0, starts_ = 0, core_resets_ = 0;
};

}  // namespace kage::test
