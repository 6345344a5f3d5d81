// SPDX-License-Identifier: Apache-2.0
#include "board/sim_board.hpp"

#include "kage/error.hpp"

namespace kage::board {

std::unique_ptr<SimBoard> open_sim_board(const std::string& board, const SimBoardOptions&) {
  throw Error("sim:" + board + ": this kage has no boards in simulation");
}

std::vector<std::string> sim_boards() { return {}; }

}  // namespace kage::board
