// SPDX-License-Identifier: Apache-2.0
// A board's whole top in simulation, from the host's serial line to the wires of its DVI link: a frame is loaded into the
// SDRAM, played, and what comes out is held against the golden core, by signatures, by registers, and by what a screen shows.
#include <fmt/format.h>
#include <zlib.h>

#include <cstring>

#include "board/board_registers.h"
#include "board/link.hpp"
#include "board/sim_board.hpp"
#include "kage/core.hpp"
#include "kage/pipeline.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::board;

TEST_CASE("a board greets, and says what it is") {
  const auto board = open_sim_board("ulx3s_25f");
  Link link(*board, {.timeout = 20000, .tries = 5, .patience = 100000});
  link.hello();
  const auto words = link.read(KAGE_BOARD_ID, 6);
  REQUIRE(words[0] == KAGE_BOARD_ID_VALUE);
  REQUIRE(words[1] == KAGE_BOARD_LAYOUT_VALUE);
  REQUIRE(words[2] == 0x554C5833);  // ULX3
  REQUIRE(words[3] == 8u << 20);
  REQUIRE(words[5] == (48u << 16 | 64));
  REQUIRE(board->state().fault == "");
}
