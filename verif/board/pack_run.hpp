// SPDX-License-Identifier: Apache-2.0
//
// Plays a pack on a board and holds what came out against it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "board/link.hpp"
#include "board/player.hpp"
#include "cosim/compare.hpp"
#include "vectors/pack.hpp"

namespace kage::board {

struct PackRunOptions {
  /// Microseconds of the line's clock for which nothing may come out while frames are played: then the core hangs.
  std::uint64_t timeout = 10'000'000;
  /// Microseconds for which the frames are played over and over once all were right; 0: until enough() says so.
  std::optional<std::uint64_t> loop;
  bool leave = false;                                ///< with `loop`: leave the board playing when all was right
  std::size_t most_captured = 16;                    ///< wrong lines of the first wrong frame whose pixels are fetched
  std::function<void()> wait;                        ///< called several times a second, but not in a loop; may throw
  std::function<bool()> enough;                      ///< asked while `loop` lasts; true ends it
  std::function<void(const std::string&)> progress;  ///< told what goes on
  std::function<void()> not_idle;  ///< told where the board could not be left idle, and what is thrown does not say so
};

/// A line whose signature was wrong, as it came when it was played again.
struct CapturedLine {
  std::uint64_t frame = 0;
  int line = 0;
  std::vector<std::uint8_t> pixels;  ///< with its channels
};

/// Result of a list that was played over and over.
struct LoopVerdict {
  std::uint64_t frames = 0;       ///< of the pack, from the first on
  std::uint64_t lines = 0;        ///< that came out, in all repetitions
  std::uint64_t repetitions = 0;  ///< whole ones
  std::uint64_t mismatches = 0;   ///< lines that differed
  double seconds = 0;
  ScreenCounts screen;  ///< from the first repetition's end on
  bool left = false;    ///< the board goes on
};

/// Verdict on a pack that was played on a board.
struct PackVerdict {
  Identity board;
  std::optional<cosim::Difference> first;  ///< none: all was as the pack says
  std::uint64_t frames = 0;                ///< that were compared; a difference ends the run
  std::uint64_t lines = 0;                 ///< whose signatures were compared
  std::uint64_t wrong_lines = 0;
  std::uint64_t registers = 0;  ///< that were compared
  std::uint64_t runs = 0;       ///< lists that were played
  std::uint64_t direct = 0;     ///< of them those of a frame that is larger than the memory
  double seconds = 0;           ///< from a list's start to its end, added up
  ScreenCounts screen;          ///< while lists were played
  LinkStatistics host;          ///< the host's end of the link
  std::uint64_t link_good = 0, link_bad = 0, link_overruns = 0;  ///< the board's end, from the greeting on
  std::optional<LoopVerdict> loop;
  std::vector<CapturedLine> captured;
  std::vector<std::string> notes;

  [[nodiscard]] bool same() const { return !first; }
};

/// Plays the pack of a folder, which has been checked (vectors::checked_pack), on the board at the other end of a link
/// that has been greeted. Whatever happens the board is left idle, unless PackRunOptions::leave says otherwise. `clock`
/// is the link's line. Throws Error of one line that begins with `port` and says what is to be done: a board that the
/// pack is not for, words that the memory damages, a link that breaks.
PackVerdict play_pack(Link& link, Transport& clock, const std::string& port, const std::filesystem::path& folder,
                      const vectors::Pack& pack, const PackRunOptions& options);

}  // namespace kage::board
