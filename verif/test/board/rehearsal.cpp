// SPDX-License-Identifier: Apache-2.0
// A board's whole top in simulation, from the host's serial line to the wires of its DVI link: a frame is loaded into
// the SDRAM, played, and what comes out is held against the golden core, by signatures, by registers, and by what a
// screen shows.
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

namespace {

/// A host's steps with a board, by its registers.
struct Host {
  explicit Host(SimBoard& board) : link(board, {.timeout = 20000, .tries = 5, .patience = 200000}) { link.hello(); }

  void write(std::uint32_t address, std::uint32_t value) { link.write(address, std::array{value}); }
  std::uint32_t read(std::uint32_t address) { return link.read(address, 1).front(); }

  Link link;
};

std::uint32_t crc_of(std::span<const std::uint32_t> words) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(words.data()), words.size_bytes()));
}

}  // namespace

TEST_CASE("a board draws a frame from its SDRAM onto a screen") {
  Config config;
  config.lanes = 2;
  config.beat_words = 1;
  config.max_width = 64;
  config.x_bits = 7;
  config.z_frac = 7;
  SceneFrames frames(std::make_shared<const Scene>(Scene::load("courtyard")), config,
                     {.width = 64, .height = 48, .frames = 1});
  std::vector<std::uint32_t> words;
  frames.frame(0, [&](std::span<const std::uint32_t> piece) { words.insert(words.end(), piece.begin(), piece.end()); });
  const Image golden = Renderer(frames).image(0);

  const auto board = open_sim_board("ulx3s_25f");
  Host host(*board);
  host.write(KAGE_BOARD_CONTROL, 0);
  REQUIRE(host.read(KAGE_REG_PARAM_HASH) == param_hash(config));

  std::vector<std::uint32_t> list{static_cast<std::uint32_t>(words.size())};
  list.insert(list.end(), words.begin(), words.end());
  list.push_back(0);
  host.write(KAGE_BOARD_LOAD_ADDRESS, 100);
  host.link.stream(list);
  host.link.flush();
  REQUIRE(host.read(KAGE_BOARD_LOAD_ADDRESS) == 100 + list.size());
  REQUIRE(host.read(KAGE_BOARD_LOAD_CRC) == crc_of(list));

  host.write(KAGE_BOARD_PLAY_ADDRESS, 100);
  host.write(KAGE_BOARD_COMMAND, 1u << KAGE_BOARD_COMMAND_START_SHIFT);
  while (host.read(KAGE_BOARD_LINES) < 48) REQUIRE(board->now() < 1'000'000);
  REQUIRE(host.read(KAGE_BOARD_PLAY_CRC) == crc_of(words));
  REQUIRE(host.read(KAGE_REG_FRAMES) == 1);
  REQUIRE(host.read(KAGE_REG_ERRORS) == 0);
  const auto signatures = host.link.read(KAGE_BOARD_SIGNATURES, 48);
  for (int y = 0; y < 48; ++y) {
    uLong crc = 0;
    for (int x = 0; x < 64; ++x) {
      crc = crc32(crc, golden.data.data() + golden.index(x, y), 3);
      const Bytef flags = static_cast<Bytef>((x == 0 && y == 0 ? 2 : 0) + (x == 63 ? 1 : 0));
      crc = crc32(crc, &flags, 1);
    }
    CAPTURE(y);
    CHECK(signatures[static_cast<std::size_t>(y)] == crc);
  }
  // What a screen at the DVI socket shows, while the player gives the core a frame whenever the screen asks for one.
  host.write(KAGE_BOARD_VIDEO_LINES, 48);
  host.write(KAGE_BOARD_CONTROL, KAGE_BOARD_CONTROL_LOOP_MASK | KAGE_BOARD_CONTROL_PACED_MASK);
  host.write(KAGE_BOARD_COMMAND, 1u << KAGE_BOARD_COMMAND_START_SHIFT);
  const std::uint32_t before = host.read(KAGE_BOARD_FRAMES_SHOWN);
  while (host.read(KAGE_BOARD_FRAMES_SHOWN) < before + 2) REQUIRE(board->now() < 2'000'000);
  (void)board->take_frames();
  while (host.read(KAGE_BOARD_FRAMES_SHOWN) < before + 6) REQUIRE(board->now() < 2'000'000);
  const std::vector<ShownFrame> shown = board->take_frames();
  CHECK(shown.size() >= 3);
  INFO(fmt::format("{} us of the board's time, {} frames", board->now(), shown.size()));
  CHECK(board->state().fault == "");
  int same = 0;
  for (const ShownFrame& frame : shown) {
    bool equal = frame.width == 64 && frame.height == 48;
    for (int y = 0; equal && y < 48; ++y)
      for (int x = 0; equal && x < 64; ++x)
        for (int c = 0; c < 3; ++c)
          equal = equal &&
                  (frame.at(x, y) >> (8 * c) & 255) == golden.data[golden.index(x, y) + static_cast<std::size_t>(c)];
    same += equal;
  }
  CHECK(same == static_cast<int>(shown.size()));
  CHECK(host.read(KAGE_BOARD_UNDERRUN_LINES) == 0);
  std::fprintf(stderr, "%lu us, %zu words, %zu frames shown, %d the same\n", board->now(), words.size(), shown.size(),
               same);
}
