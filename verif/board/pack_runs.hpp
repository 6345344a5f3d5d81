// SPDX-License-Identifier: Apache-2.0
//
// A pack cut into lists that a board can play one after the other, without a reset between them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "board/player.hpp"
#include "vectors/pack.hpp"

namespace kage::board {

/// Frames of a pack that are one list.
struct PackRun {
  std::uint64_t first = 0;   ///< of the pack's frames
  std::uint64_t frames = 0;  ///< how many
  std::uint64_t lines = 0;   ///< that they bring
  std::uint64_t words = 0;   ///< of the list: each frame with its count before it, and the 0 at the end
  int height = 0;            ///< of those that bring lines; 0: none does
  bool direct = false;       ///< it is larger than the memory, and goes from the link to the player

  [[nodiscard]] std::uint64_t end() const { return first + frames; }
};

/// Cuts where memory or signatures are full, behind frames whose registers are read, and, with a screen, where the
/// height changes, because VIDEO_LINES holds for a whole list. Throws Error that names the frame that cannot be played:
/// it has more lines than the board keeps signatures.
std::vector<PackRun> cut_into_runs(const vectors::Pack& pack, const Identity& board, const std::string& port);

/// The list that is played over and over: as many frames from the first on as fit in one; with a screen only up to
/// where the height changes. None: the first frame does not fit, or none of them brings lines.
std::optional<PackRun> loop_of(const vectors::Pack& pack, const Identity& board);

/// Why this board cannot play this pack, as one line: another PARAM_HASH or BEAT_WORDS, or a MAX_WIDTH for which a
/// frame is too wide, or not refused as it must be. Empty: it can.
std::string why_unfit(const vectors::Pack& pack, const Identity& board, const std::string& port,
                      const std::vector<std::uint32_t>& widest_refused);

/// The first frame that must be refused with SIZE, whose words why_unfit() takes; none: there is none.
std::optional<std::uint64_t> refused_for_size(const vectors::Pack& pack);

}  // namespace kage::board
