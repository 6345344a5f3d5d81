// SPDX-License-Identifier: Apache-2.0
// First light, rehearsed, on a board's whole top in simulation, with its PLL, SDRAM, serial line and the wires of its
// screen. The very functions of `kage board` play a pack on it, and the picture of a monitor at its socket is held
// against the pack too. Then the same with a fault in the board, each of which must be found and located. Cases tagged
// [rehearse] are run by tools/rehearse, since most of them have to build a board.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "board/generated/board_registers.h"
#include "board/link.hpp"
#include "board/pack_answers.hpp"
#include "board/pack_run.hpp"
#include "board/sim_board.hpp"
#include "contract/config_text.hpp"
#include "kage/core.hpp"
#include "stimulus/random.hpp"
#include "stimulus/random_frames.hpp"
#include "test/support/catch.hpp"
#include "test/support/temp_directory.hpp"
#include "vectors/check.hpp"
#include "vectors/malformed.hpp"
#include "vectors/write.hpp"

using namespace kage;
using namespace kage::board;
using kage::test::TempDirectory;

namespace {

constexpr const char* kBoard = "ulx3s_25f";
constexpr std::uint32_t kBorder = 0x402020;  // of video_out

/// A board, and the core that it has in simulation.
struct Rig {
  std::string board;
  Config config;
  int colour_bits = 8;  // of the screen; 0: there is none
};

Rig rig_of(const std::string& board, int colour_bits) {
  return {board, config_from_text(sim_core(board), board), colour_bits};
}

Rig ulx3s(const char* board = kBoard) { return rig_of(board, 8); }

Rig hx8k(bool vga) { return rig_of(vga ? "hx8k_breakout_vga" : "hx8k_breakout", vga ? 2 : 0); }

/// Two sound frames and two malformed ones, a few thousand words: 40 ms of the line.
struct Fixture {
  TempDirectory folder;
  vectors::Pack pack;

  explicit Fixture(const Config& config) {
    TempFiles files;
    vectors::PackWriter writer(folder.path(), config, files);
    pack.scene = "random";
    pack.config_name = "rehearsal";
    pack.config = config;
    pack.made_by = "a test";
    const auto add = [&](const std::string& what, const std::vector<std::uint32_t>& words) {
      pack.frames.push_back(writer.frame(what, [&](const WordSink& sink) { sink(words); }));
      pack.frames.back().settles = true;
    };
    verif::Random random(3);
    for (std::uint32_t n = 0; pack.frames.size() < 2; ++n) {
      const std::vector<std::uint32_t> words = verif::sound_frame(random, config, n);
      const FrameHeader h = FrameHeader::read(words);
      if (h.width >= 16 && h.width <= 64 && h.height >= 12 && h.height <= 48 && words.size() > 500 &&
          words.size() < 1200)
        add(fmt::format("random, frame {}", n), words);
    }
    const auto malformed = vectors::malformed_frames(config, 1);
    for (std::size_t i = 0; i < 2; ++i) add("malformed", malformed[i].words);
    pack.reads = vectors::register_reads(config, pack.frames);
    writer.finish(pack);
    files.commit();
    pack = vectors::checked_pack(folder.path(), vectors::Check::answers, [] {});
  }
};

/// Made once for each core.
const Fixture& fixture(const Rig& rig) {
  static std::map<std::string, Fixture> all;
  return all.try_emplace(fmt::format("{} {}", rig.config.x_bits, rig.config.channels), rig.config).first->second;
}

LinkOptions link_options() { return {.timeout = 10'000, .tries = 10, .patience = 100'000}; }

PackRunOptions run_options() {
  PackRunOptions o;
  o.timeout = 100'000;
  o.loop = 1;
  o.leave = true;  // the screen goes on
  return o;
}

/// A line that damages every so many bytes on their way to the board.
class Damaging : public Transport {
 public:
  Damaging(SimBoard& board, unsigned every) : board_(board), every_(every) {}
  void write(std::span<const std::uint8_t> bytes) override {
    std::vector<std::uint8_t> sent(bytes.begin(), bytes.end());
    // Only what is within a long frame: words, and neither its kind nor the flags round it.
    for (std::size_t i = 20; sent.size() > 100 && i + 10 < sent.size(); ++i)
      if (every_ != 0 && ++count_ % every_ == 0 && sent[i] != 0x7E && sent[i] != 0x7D) sent[i] ^= 0x04;
    board_.write(sent);
  }
  std::size_t read(std::span<std::uint8_t> bytes, std::uint64_t deadline) override {
    return board_.read(bytes, deadline);
  }
  std::uint64_t now() override { return board_.now(); }

 private:
  SimBoard& board_;
  unsigned every_;
  unsigned count_ = 0;
};

/// The difference between a shown screen and the frames of the pack; empty: none.
std::string wrong_on_screen(const Rig& rig, const ShownFrame& shown) {
  const Fixture& fixture_ = fixture(rig);
  const PackAnswers answers(fixture_.folder.path(), fixture_.pack);
  const int channels = rig.config.channels;
  // A screen of fewer bits shows the highest ones, and is white where all are 1.
  const unsigned levels = (1U << static_cast<unsigned>(rig.colour_bits)) - 1;
  const auto as_shown = [&](unsigned value) { return (value >> (8 - rig.colour_bits)) * 255 / levels; };
  std::string first;
  for (std::uint64_t f = 0; f < 2; ++f) {
    const vectors::PackFrame& frame = fixture_.pack.frames[f];
    const std::vector<std::uint8_t> pixels = answers.pixels(f, 0, frame.status.height);
    std::string wrong;
    for (int y = 0; y < shown.height && wrong.empty(); ++y) {
      for (int x = 0; x < shown.width && wrong.empty(); ++x) {
        const bool inside = x < frame.status.width && y < frame.status.height;
        for (int c = 0; c < 3; ++c) {
          const auto at = static_cast<std::size_t>((y * frame.status.width + x) * channels + std::min(c, channels - 1));
          const unsigned want = as_shown(inside ? pixels[at] : kBorder >> (8 * c) & 255);
          const unsigned got = shown.at(x, y) >> (8 * c) & 255;
          if (want != got && wrong.empty())
            wrong = fmt::format("the screen: frame {}, line {}, x {}, channel {}: expected {}, got {}", f, y, x, c,
                                want, got);
        }
      }
    }
    if (wrong.empty()) return "";
    if (first.empty()) first = wrong;
  }
  return first;
}

/// Lets the board come out of reset, and say so.
void settle(SimBoard& board) {
  std::uint8_t byte = 0;
  while (board.read({&byte, 1}, board.now() + 100) != 0) {
  }
}

/// Plays the pack, and watches the screen for a few frames. Gives the fault that was found, in a line; "same": none.
std::string rehearse(const SimBoardOptions& options, unsigned damage = 0, const Rig& rig = ulx3s()) {
  const auto board = open_sim_board(rig.board, options);
  const auto with_fault = [&](const std::string& told) {
    const std::string fault = board->state().fault;
    return fault.empty() ? told : fault;
  };
  try {
    Damaging line(*board, damage);
    settle(*board);
    Link link(line, link_options());
    link.hello();
    const PackVerdict v = play_pack(link, line, "sim", fixture(rig).folder.path(), fixture(rig).pack, run_options());
    if (v.first)
      return with_fault(fmt::format("frame {}, line {}, x {}: {}: expected {}, got {} {}", v.first->frame,
                                    v.first->line, v.first->x, v.first->field, v.first->expected, v.first->actual,
                                    v.first->remark));
    if (damage != 0 && v.link_bad == 0) return "no damage was seen";
    if (damage == 0 && v.link_bad + v.host.answers_damaged != 0)
      return fmt::format("the link: {} frames came damaged to the board, {} to the host, on a line that damages none",
                         v.link_bad, v.host.answers_damaged);
    if (rig.colour_bits == 0) return with_fault("same");
    (void)board->take_frames();
    std::vector<ShownFrame> shown;
    while (shown.size() < 3) {
      (void)link.read(KAGE_BOARD_STATE, 1);
      for (ShownFrame& frame : board->take_frames()) shown.push_back(std::move(frame));
    }
    for (const ShownFrame& frame : shown)
      if (const std::string wrong = wrong_on_screen(rig, frame); !wrong.empty()) return with_fault(wrong);
    const auto late = link.read(KAGE_BOARD_UNDERRUN_LINES, 1).front();
    if (late != 0) return fmt::format("{} lines ran short", late);
    return with_fault("same");
  } catch (const Error& e) {
    return with_fault(e.what());
  }
}

/// Taps the reset button at any moment for any time, plays the pack then. Gives the fault that was found; "same": none.
std::string tap(const SimBoardOptions& options) {
  const auto board = open_sim_board(kBoard, options);
  try {
    settle(*board);
    verif::Random random(5);
    for (int i = 0; i < 200; ++i) {
      board->tap_reset(static_cast<std::uint64_t>(random.in(1'000, 60'000)));
      std::uint8_t byte = 0;
      (void)board->read({&byte, 1}, board->now() + static_cast<std::uint64_t>(random.in(1, 4)));
    }
    settle(*board);
    Link link(*board, link_options());
    link.hello();
    const Rig rig = ulx3s();
    const Fixture& f = fixture(rig);
    const PackVerdict v = play_pack(link, *board, "sim", f.folder.path(), f.pack, run_options());
    return v.same() ? "same" : v.first->remark;
  } catch (const Error& e) {
    return e.what();
  }
}

}  // namespace

TEST_CASE("first light: a pack on a board, and its frames on a screen") { CHECK(rehearse({}) == "same"); }

// 15 bits in a period of the crystal, and positive syncs.
TEST_CASE("first light of a board whose bits take no whole number of picoseconds", "[.][rehearse]") {
  CHECK(rehearse({}, 0, ulx3s("ulx3s_85f")) == "same");
}

// The rehearsal's 12F has pads whose words come 2.5 ns later than the 25F takes them.
TEST_CASE("first light of a board with slow pads, whose words are taken at the other edge", "[.][rehearse]") {
  CHECK(rehearse({}, 0, ulx3s("ulx3s_12f")) == "same");
}

TEST_CASE("first light of the HX8K board: frames from block RAM, no screen", "[.][rehearse]") {
  CHECK(rehearse({}, 0, hx8k(false)) == "same");
}

TEST_CASE("first light of the HX8K board with VGA, which keeps no pixels of a line") {
  CHECK(rehearse({}, 0, hx8k(true)) == "same");
}

TEST_CASE("a line that damages a byte in 1500 only costs time", "[.][rehearse]") {
  CHECK(rehearse({}, 1500) == "same");
}

TEST_CASE("a host at another rate than the board's gets no answer") {
  const auto board = open_sim_board(kBoard, {.fault = {}, .other_baud = 115'200});
  settle(*board);
  Link link(*board, {.timeout = 5'000, .tries = 2, .patience = 0});
  try {
    link.hello();
    FAIL("it was greeted");
  } catch (const LinkError& e) {
    CHECK(e.failure == LinkFailure::no_answer);
  }
}

TEST_CASE("a board that is reset in the middle says so") {
  const auto board = open_sim_board(kBoard);
  Link link(*board, link_options());
  link.hello();
  PackRunOptions options = run_options();
  int waits = 0;
  options.wait = [&] {
    if (++waits != 3) return;
    board->press_reset(true);
    settle(*board);
    board->press_reset(false);
  };
  try {
    (void)play_pack(link, *board, "sim", fixture(ulx3s()).folder.path(), fixture(ulx3s()).pack, options);
    FAIL("it went on");
  } catch (const Error& e) {
    CHECK_THAT(e.what(), Catch::Matchers::ContainsSubstring("reset"));
  }
}

TEST_CASE("a button that is tapped for less than a clock, or bounces, resets all clocks or none", "[.][rehearse]") {
  CHECK(tap({}) == "same");
}

TEST_CASE("every fault of a board is found, and told where", "[.][rehearse][faults]") {
  struct Fault {
    const char* name;
    const char* told;  // what must be told
    unsigned damage = 0;
  };
  const char* one = std::getenv("KAGE_BOARD_FAULT");
  for (const Fault& fault : {
           Fault{"swapped_channel", "the screen: frame 0, line 0, x 0, channel 2"},
           {"sync_polarity", "screen: hsync"},
           {"tmds_disparity", "DVI: "},
           {"no_refresh", "u_rules.refreshes"},
           {"reset_early", "reset 2 is released after 1"},  // 17 or 18: its first flip-flop may take good_i late
           {"crc_unchecked", "LOAD_CRC", 150},
       }) {
    if (one != nullptr && std::string(one) != fault.name) continue;
    const std::string told = rehearse({.fault = fault.name, .other_baud = {}}, fault.damage);
    fmt::print("{}: {}\n", fault.name, told);
    INFO(fault.name);
    CHECK(told != "same");
    CHECK_THAT(told, Catch::Matchers::ContainsSubstring(fault.told));
  }
}

TEST_CASE("a reset that a tap of the button brings to some clocks only is found", "[.][rehearse][faults]") {
  CHECK_THAT(tap({.fault = "reset_in_parts", .other_baud = {}}),
             Catch::Matchers::ContainsSubstring("not all clocks were in reset at once"));
}

TEST_CASE("a frame of credit too many is found", "[.][rehearse][faults]") {
  const auto overrun = [](const std::string& fault) {
    const auto board = open_sim_board(kBoard, {.fault = fault, .other_baud = {}});
    Link link(*board, link_options());
    link.hello();
    // Straight to a player that does not play: no word is taken.
    link.write(KAGE_BOARD_CONTROL, std::vector<std::uint32_t>{KAGE_BOARD_CONTROL_DIRECT_MASK});
    try {
      link.stream(std::vector<std::uint32_t>(std::size_t{63} * 8, 5));
      link.flush();
    } catch (const LinkError& e) {
      return e.failure;
    }
    FAIL("all went through");
    return LinkFailure::no_answer;
  };
  CHECK(overrun("") == LinkFailure::stalled);
  CHECK(overrun("credit_too_many") == LinkFailure::overrun);
}
