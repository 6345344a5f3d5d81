// SPDX-License-Identifier: Apache-2.0
//
// A board's player by its registers (rtl/defs/board.yaml): what it is, loading a list of frames, playing it, and what
// came out. The contract of the list stands in rtl/board/stream_player.sv.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "board/link.hpp"

namespace kage::board {

/// The CRC-32 of words as zlib has it of their bytes, the lowest first; `before` is that of the words before them.
std::uint32_t crc_of(std::span<const std::uint32_t> words, std::uint32_t before = 0);

/// Identity and sizes of a board, as it tells them.
struct Identity {
  std::string name;                 ///< four letters
  std::uint32_t memory_words = 0;   ///< of the memory that frames are played from
  std::uint32_t lines = 0;          ///< whose signatures it keeps
  std::uint32_t pixels = 0;         ///< of a line that it can capture
  std::uint32_t screen_width = 0;   ///< 0: it has no screen
  std::uint32_t screen_height = 0;  ///< lines
  std::uint32_t core_id = 0;        ///< the core's registers ID, VERSION, PARAM_HASH and SHAPE
  std::uint32_t version = 0;
  std::uint32_t param_hash = 0;
  std::uint32_t shape = 0;

  [[nodiscard]] bool has_screen() const { return screen_width != 0 && screen_height != 0; }
};

/// How far the player is.
struct PlayState {
  bool playing = false;
  bool memory_ready = false;
  std::uint32_t play_crc = 0;  ///< of the words given to the core since start()
  std::uint32_t played = 0;    ///< frames whose words the core has
  std::uint32_t lines = 0;     ///< that came out
};

/// Counts of the screen.
struct ScreenCounts {
  std::uint64_t shown = 0;            ///< screens that began a frame
  std::uint64_t late = 0;             ///< screens that had none to begin, though one was shown before
  std::uint64_t underrun_frames = 0;  ///< late ones, and those with a line that ran short
  std::uint64_t underrun_lines = 0;   ///< lines that ran short

  ScreenCounts operator-(const ScreenCounts& before) const {
    return {shown - before.shown, late - before.late, underrun_frames - before.underrun_frames,
            underrun_lines - before.underrun_lines};
  }
};

/// Counts of the board since the Player first asked for its state. The board counts modulo 2^16; each state() adds what
/// has come since the one before, so state() must be called before 2^16 frames of the link or lines have passed.
struct BoardCounts {
  ScreenCounts screen;
  std::uint64_t link_good = 0;      ///< right frames that came by the link
  std::uint64_t link_bad = 0;       ///< other frames
  std::uint64_t link_overruns = 0;  ///< right frames that found no room
};

/// Functions throw LinkError, and Error of one line that begins with the port's name.
class Player {
 public:
  /// `port` is what messages call the board; the link has been greeted. `wait` is called now and then while words are
  /// sent, and may throw.
  Player(Link& link, std::string port, std::function<void()> wait);

  /// Asks the board what it is, and its core, which is let go for it. Throws Error of what is no kage board, of a
  /// layout of registers that this kage does not know, and of a core of another version.
  Identity identify();

  /// Holds core and player in reset, and lets them go with these bits of CONTROL: then nothing is played, and the core
  /// is as after power-up.
  void restart(std::uint32_t control = 0);
  /// The bits of CONTROL besides HOLD, while nothing is played.
  void control(std::uint32_t bits);

  /// Puts words into the memory, and holds what arrived against them: when it differs, once more. Throws Error if it
  /// differs again.
  void load(std::uint32_t address, std::span<const std::uint32_t> words);
  /// Gives words to the player itself, with DIRECT.
  void direct(std::span<const std::uint32_t> words);

  void start(std::uint32_t address);
  void stop();
  /// How far the player is; counts() is brought up to date too.
  PlayState state();
  /// As of the last call of state().
  [[nodiscard]] const BoardCounts& counts() const { return counts_; }

  void set(std::uint32_t address, std::uint32_t value);
  std::uint32_t get(std::uint32_t address);
  /// Signatures of lines, from the first on.
  std::vector<std::uint32_t> signatures(std::size_t lines);
  /// Sets the signature that each line must have, for CHECK.
  void expect(std::span<const std::uint32_t> signatures);
  /// Pixels of the captured line as PIXELS has them, `most` at most, and how many came.
  std::vector<std::uint32_t> captured(std::uint32_t most, std::uint32_t& came);

  /// STOP, then HOLD. False if the board could not be reached.
  bool leave_idle() noexcept;

  [[nodiscard]] const std::string& port() const { return port_; }
  [[nodiscard]] Link& link() { return link_; }

 private:
  void send(std::span<const std::uint32_t> words);
  void count(std::span<const std::uint32_t> registers);

  Link& link_;
  std::string port_;
  std::function<void()> wait_;
  BoardCounts counts_;
  std::vector<std::uint32_t> counted_;  // the registers of counts as they were last
};

}  // namespace kage::board
