// SPDX-License-Identifier: Apache-2.0
//
// A board in simulation: the very top of constraints/boards with behavioural primitives round it, as a library that
// Verilator made, and a line to it that counts the board's own microseconds.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "board/screen.hpp"
#include "board/transport.hpp"

namespace kage::board {

/// State of a board in simulation, besides the bytes that it sends.
struct SimBoardState {
  std::uint64_t microseconds = 0;  ///< of the board's time
  std::uint8_t leds = 0;
  std::string fault;  ///< what the screen or a chip found wrong first (timing, TMDS, SDRAM's rules); else empty
};

/// The line to a board in simulation. Its clock is the board's: it stands still while the host thinks, so a run is the
/// same every time.
class SimBoard : public Transport {
 public:
  /// The board's state now.
  [[nodiscard]] virtual SimBoardState state() = 0;
  /// Frames that the screen showed from sync to sync since they were taken last, the oldest first; none of a board
  /// without a screen.
  virtual std::vector<ShownFrame> take_frames() = 0;
  /// Presses the button that resets the board, or lets it go. A board without one goes on.
  virtual void press_reset(bool pressed) = 0;
  /// Presses it for so many picoseconds of the board's time.
  virtual void tap_reset(std::uint64_t picoseconds) = 0;
};

struct SimBoardOptions {
  std::string fault;                   ///< of verif/board/faults.yaml, that the board is built with; empty: none
  std::optional<unsigned> other_baud;  ///< the host's rate, where it is not the board's
};

/// Builds the model of `board` (a name in constraints/boards/boards.yaml) unless there is one, and powers it up. Throws
/// Error for an unknown board, naming those that there are, and where Verilator is missing or refuses the source.
std::unique_ptr<SimBoard> open_sim_board(const std::string& board, const SimBoardOptions& options = {});

/// The boards that open_sim_board knows, in the file's order.
std::vector<std::string> sim_boards();

/// The parameters of the core that `board` has in simulation, as a line of YAML. Throws Error for an unknown board.
std::string sim_core(const std::string& board);

}  // namespace kage::board
