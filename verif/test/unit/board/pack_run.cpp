// SPDX-License-Identifier: Apache-2.0
// A pack on a board: the same, and each thing that can be wrong, told by name and place; whatever happens the board is
// idle afterwards. The board is one of C++ (test/support/fake_board.hpp).
#include "board/pack_run.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "board/connection.hpp"
#include "board/pack_runs.hpp"
#include "board/sim_board.hpp"
#include "contract/config_text.hpp"
#include "kage/config.hpp"
#include "stimulus/random_frames.hpp"
#include "test/support/catch.hpp"
#include "test/support/fake_board.hpp"
#include "test/support/temp_directory.hpp"
#include "vectors/capture.hpp"
#include "vectors/check.hpp"
#include "vectors/malformed.hpp"
#include "vectors/write.hpp"

using namespace kage;
using namespace kage::board;
using kage::test::FakeBoard;
using kage::test::TempDirectory;

namespace {

constexpr int kSound = 6;

const Config& config() {
  static const Config c = load_config("tiny").config;
  return c;
}

/// How many lines of a frame are like no other of it.
std::size_t lonely(const std::vector<std::uint32_t>& words) {
  std::map<std::vector<std::uint8_t>, int> rows;
  GoldenCore(config()).frame(words, [&](int, std::span<const std::uint8_t> row) {
    ++rows[std::vector<std::uint8_t>(row.begin(), row.end())];
  });
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [](const auto& r) { return r.second == 1; }));
}

/// Frames of some lines each, then malformed ones, one by one and right behind each other.
struct Fixture {
  TempDirectory folder;
  vectors::Pack pack;

  Fixture() {
    TempFiles files;
    vectors::PackWriter writer(folder.path(), config(), files);
    pack.scene = "random";
    pack.config_name = "tiny";
    pack.config = config();
    pack.made_by = "a test";
    const auto add = [&](const std::string& what, const std::vector<std::uint32_t>& words, bool settles) {
      pack.frames.push_back(writer.frame(what, [&](const WordSink& sink) { sink(words); }));
      pack.frames.back().settles = settles;
    };
    verif::Random random(5);
    for (std::uint32_t n = 0; pack.frames.size() < kSound; ++n) {
      const std::vector<std::uint32_t> words = verif::sound_frame(random, config(), n);
      const FrameHeader h = FrameHeader::read(words);
      // Lines that are like no other tell of faults in one line.
      if (h.width >= 4 && h.width <= 64 && h.height >= 8 && h.height <= 40 && words.size() < 2000 && lonely(words) >= 5)
        add("random, frame " + std::to_string(n), words, false);
    }
    const auto malformed = vectors::malformed_frames(config(), 1);
    for (const auto& m : malformed) add("malformed", m.words, true);
    for (const auto& m : malformed) add("malformed", m.words, false);
    pack.frames.back().settles = true;
    pack.reads = vectors::register_reads(config(), pack.frames);
    writer.finish(pack);
    files.commit();
    pack = vectors::checked_pack(folder.path(), vectors::Check::answers, [] {});
  }
  [[nodiscard]] std::uint64_t lines_before(std::uint64_t frame) const {
    std::uint64_t n = 0;
    for (std::uint64_t i = 0; i < frame; ++i) n += pack.frames[i].pixels() > 0 ? pack.frames[i].lines() : 0;
    return n;
  }
  [[nodiscard]] std::uint64_t lines() const { return lines_before(pack.frames.size()); }
};

const Fixture& fixture() {
  static const Fixture f;
  return f;
}

LinkOptions link_options() {
  LinkOptions o;
  o.timeout = 20'000;
  o.patience = 100'000;
  return o;
}

PackRunOptions options() {
  PackRunOptions o;
  o.timeout = 100'000;
  return o;
}

PackVerdict play(FakeBoard& board, const PackRunOptions& o = options()) {
  Link link(board, link_options());
  link.hello();
  PackVerdict v = play_pack(link, board, "PORT", fixture().folder.path(), fixture().pack, o);
  if (!v.loop || !v.loop->left) CHECK(board.held());
  return v;
}

/// The message about a board on which the pack cannot be played.
std::string trouble(FakeBoard& board, const PackRunOptions& o = options()) {
  try {
    (void)play(board, o);
  } catch (const Error& e) {
    const std::string text = e.what();
    CHECK(text.substr(0, 6) == "PORT: ");
    CHECK(text.find('\n') == std::string::npos);
    return text;
  }
  return "no trouble";
}

bool has(const std::string& text, const std::string& part) {
  const bool found = text.find(part) != std::string::npos;
  if (!found) UNSCOPED_INFO(text);
  return found;
}

/// The rows of a frame.
std::vector<std::vector<std::uint8_t>> rows_of(std::uint64_t frame) {
  std::vector<std::vector<std::uint8_t>> rows;
  GoldenCore(config()).frame(
      vectors::words_of(fixture().folder.path(), fixture().pack, frame),
      [&](int, std::span<const std::uint8_t> row) { rows.emplace_back(row.begin(), row.end()); });
  return rows;
}

/// Spoils a channel of a pixel whenever the pixels of one line of a frame come, which no other line of the sound frames
/// has.
struct Spoil {
  int line = -1;
  int x, channel;
  std::vector<std::uint8_t> row;

  Spoil(std::uint64_t frame, int least_line, int at, int c) : x(at), channel(c) {
    std::vector<std::vector<std::uint8_t>> all;
    for (std::uint64_t f = 0; f < kSound; ++f)
      for (auto& r : rows_of(f)) all.push_back(std::move(r));
    const auto rows = rows_of(frame);
    for (auto y = static_cast<std::size_t>(least_line); y < rows.size() && line < 0; ++y)
      if (std::count(all.begin(), all.end(), rows[y]) == 1) {
        line = static_cast<int>(y);
        row = rows[y];
      }
    REQUIRE(line >= 0);
  }
  [[nodiscard]] std::size_t place() const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(config().channels) +
           static_cast<std::size_t>(channel);
  }
  void operator()(std::span<std::uint8_t> pixels) const {
    if (std::equal(pixels.begin(), pixels.end(), row.begin(), row.end())) pixels[place()] ^= 0x10;
  }
};

}  // namespace

TEST_CASE("a sound board is the same in every line and register") {
  FakeBoard board(config());
  const PackVerdict v = play(board);
  INFO((v.first ? cosim::describe(*v.first) : ""));
  CHECK(v.same());
  CHECK(v.board.name == "FAKE");
  CHECK(v.frames == fixture().pack.frames.size());
  CHECK(v.lines == fixture().lines());
  CHECK(v.wrong_lines == 0);
  CHECK(v.registers == fixture().pack.reads.size());
  CHECK(v.direct == 0);
  CHECK(v.captured.empty());
  CHECK(v.link_bad == 0);
  CHECK(v.host.resent == 0);
  CHECK(!v.loop);
  // A run ends behind each frame whose registers are read, and nothing is reset between two.
  CHECK(v.runs == static_cast<std::uint64_t>(std::count_if(fixture().pack.frames.begin(), fixture().pack.frames.end(),
                                                           [](const auto& f) { return f.settles; })));
  CHECK(board.starts() == v.runs);
}

TEST_CASE("a wrong colour is found by frame, line, x and channel") {
  for (const int channel : {0, 2}) {
    const int c = std::min(channel, config().channels - 1);
    for (const int frame : {0, 3}) {
      FakeBoard board(config());
      const Spoil spoil(static_cast<std::uint64_t>(frame), frame == 0 ? 0 : 2, 3, c);
      board.spoil = [&](std::uint64_t, std::span<std::uint8_t> pixels) { spoil(pixels); };
      const PackVerdict v = play(board);
      REQUIRE(v.first);
      INFO(cosim::describe(*v.first));
      CHECK(v.first->frame == frame);
      CHECK(v.first->line == spoil.line);
      CHECK(v.first->x == 3);
      CHECK(v.first->field == (config().channels == 1 ? "grey" : c == 0 ? "red" : "blue"));
      CHECK((v.first->expected ^ v.first->actual) == 0x10);
      CHECK(v.frames == static_cast<std::uint64_t>(frame) + 1);
      REQUIRE(v.captured.size() == 1);
      CHECK(v.captured[0].frame == static_cast<std::uint64_t>(frame));
      CHECK(v.captured[0].line == spoil.line);
      std::vector<std::uint8_t> wanted = spoil.row;
      wanted[spoil.place()] ^= 0x10;
      CHECK(v.captured[0].pixels == wanted);
    }
  }
}

TEST_CASE("all wrong lines of the first wrong frame are captured, as far as is asked for") {
  FakeBoard board(config());
  const auto rows = rows_of(1);
  board.spoil = [&](std::uint64_t, std::span<std::uint8_t> pixels) {
    if (pixels.size() == rows[0].size()) pixels.back() ^= 1;
  };
  PackRunOptions o = options();
  o.most_captured = 3;
  const PackVerdict v = play(board, o);
  REQUIRE(v.first);
  CHECK(v.captured.size() == 3);
  REQUIRE(!v.notes.empty());
  CHECK(has(v.notes.back(), "3 of "));
}

TEST_CASE("a fault that does not repeat is said to be none of the logic's") {
  FakeBoard board(config());
  const std::uint64_t place = fixture().lines_before(2) + 1;
  board.spoil = [&](std::uint64_t at, std::span<std::uint8_t> pixels) {
    if (at == place) pixels[0] ^= 1;
  };
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->frame == 2);
  CHECK(v.first->line == 1);
  CHECK(v.first->x == -1);
  CHECK(v.first->field == "signature");
  CHECK(has(v.first->remark, "does not repeat"));
  CHECK(v.wrong_lines == 1);
}

TEST_CASE("a fault that takes the frames before it is said to") {
  FakeBoard board(config());
  const std::uint64_t place = fixture().lines_before(3) + 1;
  std::uint64_t core_lines = 0;
  std::uint64_t resets = board.core_resets();
  board.spoil = [&](std::uint64_t, std::span<std::uint8_t> pixels) {
    if (board.core_resets() != resets) core_lines = 0;
    resets = board.core_resets();
    if (core_lines++ == place) pixels[1] ^= 0x80;
  };
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->frame == 3);
  CHECK(v.first->line == 1);
  CHECK(v.first->x >= 0);
  REQUIRE(v.notes.size() == 1);
  CHECK(has(v.notes[0], "frame 3 alone comes out right"));
}

TEST_CASE("TLAST, TUSER and a line's length are looked at too") {
  FakeBoard board(config());
  board.kept_pixels = 2;  // the rest of a line is not kept
  const Spoil spoil(1, 1, 3, 0);
  board.spoil = [&](std::uint64_t, std::span<std::uint8_t> pixels) { spoil(pixels); };
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->frame == 1);
  CHECK(has(v.first->remark, "the first 2 pixels"));
}

TEST_CASE("a board that keeps no pixels tells the line") {
  FakeBoard board(config());
  board.kept_pixels = 0;
  const Spoil spoil(1, 1, 3, 0);
  board.spoil = [&](std::uint64_t, std::span<std::uint8_t> pixels) { spoil(pixels); };
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->frame == 1);
  CHECK(v.first->line == 1);
  CHECK(v.first->field == "signature");
  CHECK(has(v.first->remark, "the board keeps no pixels"));
  CHECK(v.captured.empty());
}

TEST_CASE("a register that is wrong is named") {
  FakeBoard board(config());
  board.core_says = [](std::uint32_t address, std::uint32_t value) {
    return address == KAGE_REG_ERRORS && value == 3 ? 4U : value;
  };
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->field == "register");
  CHECK(v.first->frame == kSound + 2);
  CHECK(v.first->of_registers());
  CHECK(has(v.first->remark, "register ERRORS (0x2c): expected 0x3, got 0x4"));
}

TEST_CASE("memory that gives other words is to blame, and not the core") {
  FakeBoard board(config());
  const auto runs = cut_into_runs(
      fixture().pack,
      [] {
        Identity id;
        id.memory_words = 1U << 16U;
        id.lines = 512;
        return id;
      }(),
      "PORT");
  REQUIRE(runs[0].frames > 3);
  std::uint32_t at = 2;  // in frame 2, behind its count
  for (std::size_t i = 0; i < 2; ++i) at += static_cast<std::uint32_t>(fixture().pack.frames[i].words) + 1;
  board.memory_gives = [&](std::uint32_t address, std::uint32_t word) { return address == at + 3 ? word ^ 1U : word; };
  const std::string text = trouble(board);
  CHECK(has(text, "the memory gives other words than were loaded into it, first in frame 2 (random, frame "));
  CHECK(board.held());
}

TEST_CASE("memory that gives another count of words is to blame too") {
  FakeBoard board(config());
  const auto second = static_cast<std::uint32_t>(fixture().pack.frames[0].words) + 1;
  board.memory_gives = [&](std::uint32_t address, std::uint32_t word) { return address == second ? 0 : word; };
  CHECK(has(trouble(board), "the memory gives other words than were loaded into it, first in frame 1 "));
}

TEST_CASE("memory that gives another word once is said to do so") {
  FakeBoard board(config());
  bool once = false;
  board.memory_gives = [&](std::uint32_t address, std::uint32_t word) {
    return address == 9 && !std::exchange(once, true) ? word ^ 1U : word;
  };
  CHECK(has(trouble(board), "not in the same place each time"));
}

TEST_CASE("memory that gives no word is to blame, and no core that hangs") {
  const auto second = static_cast<std::uint32_t>(fixture().pack.frames[0].words) + 1;
  const auto told = [](std::uint32_t from) {
    FakeBoard board(config());
    board.memory_ends = [=](std::uint32_t address) { return address >= from; };
    return trouble(board);
  };
  CHECK(
      has(told(0), "no word comes to the core behind the start of the list: the memory gives none, or the core takes"));
  CHECK(has(told(1), "no word comes to the core behind the start of the list: "));
  CHECK(has(told(second), "no word comes to the core behind frame 0: "));
  CHECK(has(told(2),
            "board FAKE: the memory gives no more words behind word 1 of frame 0, and the core waits for them: "
            "look at the memory's clock, supply and pins; the core is not to blame"));
  CHECK(has(told(second + 4), "the memory gives no more words behind word 3 of frame 1, and the core waits"));
  // One that gave other words before it stopped is told by these.
  FakeBoard both(config());
  both.memory_gives = [](std::uint32_t address, std::uint32_t word) { return address == 3 ? word ^ 1U : word; };
  both.memory_ends = [](std::uint32_t address) { return address >= 9; };
  CHECK(has(trouble(both), "the memory gives other words than were loaded into it, first in frame 0 "));
  // In a repetition.
  FakeBoard late(config());
  std::uint64_t reads = 0;
  late.memory_ends = [&](std::uint32_t address) {
    return (late.control() & KAGE_BOARD_CONTROL_LOOP_MASK) != 0 && address == second + 4 && ++reads == 4;
  };
  PackRunOptions o = options();
  o.loop = 10'000'000;
  CHECK(has(trouble(late, o), "the memory gives no more words behind word 3 of frame 1, and the core waits"));
}

TEST_CASE("words that reach the memory damaged are sent once more") {
  FakeBoard board(config());
  board.arrives = [](std::uint64_t number, std::uint32_t word) { return number == 20 ? word ^ 4U : word; };
  CHECK(play(board).same());
  FakeBoard worse(config());
  worse.arrives = [](std::uint64_t, std::uint32_t word) { return word ^ 4U; };
  CHECK(has(trouble(worse), "words reached the board damaged, twice"));
}

TEST_CASE("bytes that the line loses or damages change nothing but the time") {
  FakeBoard board(config());
  verif::Random random(3);
  std::uint64_t hurt = 0;
  const auto hurts = [&](std::uint8_t& byte) {
    if (!random.chance(0.003)) return true;
    ++hurt;
    if (random.chance(0.5)) return false;
    byte ^= static_cast<std::uint8_t>(1U << (hurt % 8));
    return true;
  };
  board.to_board = board.to_host = hurts;
  const PackVerdict v = play(board);
  CHECK(v.same());
  CHECK(hurt > 3);
  CHECK(v.host.resent > 0);
  CHECK(v.link_bad > 0);
}

TEST_CASE("a core of another configuration is refused, with what to do") {
  FakeBoard board(config());
  board.other_hash = param_hash(load_config("glass").config);
  const std::string text = trouble(board);
  CHECK(has(text, "(glass)"));
  CHECK(has(text, "load a bitstream of tiny, or make the pack with kage vectors ... --config glass"));
  CHECK(board.held());
  FakeBoard unknown(config());
  unknown.other_hash = 0x12345678;
  CHECK(has(trouble(unknown), "PARAM_HASH 12345678"));
  // For a board in simulation it says which core that has, as build_board.py knows it.
  Identity simulated;
  simulated.name = "FAKE";
  simulated.param_hash = 0x12345678;
  CHECK(has(why_unfit(fixture().pack, simulated, "sim:hx8k_breakout_vga", {}),
            "make the pack for the core of the simulation: kage vectors ... --config FILE, where FILE has the line "
            "{X_BITS: 8, Z_BITS: 16, Z_FRAC: 8, CHANNELS: 1, DSF_BITS: 0, FSF: 0, LANES: 1, MAX_WIDTH: 160, "
            "BEAT_WORDS: 1}"));
  for (const std::string& name : sim_boards()) CHECK_NOTHROW(config_from_text(sim_core(name), name));
  CHECK_THROWS_WITH(sim_core("nothing"),
                    "sim:nothing: no board with a simulation; there are ulx3s_25f, ulx3s_12f, ulx3s_85f, "
                    "hx8k_breakout, hx8k_breakout_vga");
}

TEST_CASE("a core that is too narrow, or of other beats, is refused") {
  const auto shaped = [](std::uint32_t mask, std::uint32_t bits) {
    auto board = std::make_unique<FakeBoard>(config());
    board->core_says = [=](std::uint32_t address, std::uint32_t value) {
      return address == KAGE_REG_SHAPE ? (value & ~mask) | bits : value;
    };
    return board;
  };
  CHECK(has(trouble(*shaped(KAGE_SHAPE_MAX_WIDTH_MASK, 3)), "MAX_WIDTH 3, and frame 0"));
  CHECK(has(trouble(*shaped(KAGE_SHAPE_BEAT_WORDS_MASK, KAGE_FIELD_IS(KAGE_SHAPE_BEAT_WORDS, 8U))), "BEAT_WORDS 8"));
  // More lanes draw the same, and SHAPE is not held against the pack's.
  CHECK(play(*shaped(KAGE_SHAPE_LANES_MASK, KAGE_FIELD_IS(KAGE_SHAPE_LANES, 2U))).same());
}

TEST_CASE("what is no board, or another layout, is refused") {
  FakeBoard board(config());
  board.layout = 9;
  CHECK(has(trouble(board), "layout 9"));
}

TEST_CASE("a small memory takes several runs, and a frame that is larger goes from the link") {
  std::uint64_t most = 0;
  for (const auto& f : fixture().pack.frames) most = std::max(most, f.words);
  FakeBoard board(config());
  board.memory_words = static_cast<std::uint32_t>(most + 2);
  const PackVerdict v = play(board);
  CHECK(v.same());
  CHECK(v.direct == 0);
  FakeBoard smaller(config());
  smaller.memory_words = static_cast<std::uint32_t>(most + 1);
  const PackVerdict d = play(smaller);
  CHECK(d.same());
  CHECK(d.direct == 1);
  FakeBoard lines(config());
  lines.kept_lines = 40;
  const PackVerdict few = play(lines);
  CHECK(few.same());
  CHECK(few.lines == fixture().lines());
  FakeBoard none(config());
  none.kept_lines = 3;
  CHECK(has(trouble(none), "keeps signatures of 3: make the pack with a smaller --size"));
}

TEST_CASE("a frame from the link that comes out wrong is played from the link again") {
  FakeBoard board(config());
  board.memory_words = 4;
  const Spoil spoil(2, 1, 2, 0);
  board.spoil = [&](std::uint64_t, std::span<std::uint8_t> pixels) { spoil(pixels); };
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->frame == 2);
  CHECK(v.first->line == spoil.line);
  CHECK(v.first->x == 2);
  CHECK(v.direct == 3);
}

TEST_CASE("a core that hangs is told from one that is slow") {
  FakeBoard board(config());
  board.hangs_in = 1;
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->frame == 1);
  CHECK(v.first->line == 1);
  CHECK(v.first->field == "missing");
  CHECK(has(v.first->remark, "the core hangs: nothing more comes in 0.1 s: STATUS 0x1 (a frame is open)"));
  CHECK(v.frames == 2);
}

TEST_CASE("registers that alternate are no board that is slow") {
  // The core hangs, and a register says now this and now that, which once kept kage waiting for ever.
  const auto alternate = [](FakeBoard& board, std::uint32_t at, std::uint64_t frame) {
    board.hangs_in = frame;
    board.board_says = [at, frame, &board, reads = 0](std::uint32_t address, std::uint32_t value) mutable {
      const bool looped = (board.control() & KAGE_BOARD_CONTROL_LOOP_MASK) != 0;
      if (looped != (frame > fixture().pack.frames.size())) return value;
      if (++reads > 1'000'000) throw std::runtime_error("it waits for ever");
      return address == at && value > 0 && reads / 40 % 2 == 0 ? value - 1 : value;
    };
  };
  FakeBoard lines(config());
  alternate(lines, KAGE_BOARD_LINES, 1);
  CHECK(has(trouble(lines), "PORT: board FAKE: LINES goes back from "));
  FakeBoard played(config());
  alternate(played, KAGE_BOARD_PLAYED, 1);
  CHECK(has(trouble(played), "PORT: board FAKE: PLAYED goes back from 1 to 0 while it played frames 0 to "));
  FakeBoard crc(config());
  alternate(crc, KAGE_BOARD_PLAY_CRC, 1);
  try {
    const PackVerdict v = play(crc);
    REQUIRE(v.first);
    CHECK(has(v.first->remark, "the core hangs"));
  } catch (const Error& e) {
    CHECK(has(e.what(), "the memory gives"));  // so it looks, where words and their check do not fit
  }
  FakeBoard huge(config());
  huge.board_says = [reads = 0U](std::uint32_t address, std::uint32_t value) mutable {
    return address == KAGE_BOARD_LINES && value > 0 ? 0xFFFFFFF0 + reads++ % 16 : value;
  };
  CHECK(has(trouble(huge), "PORT: LINES reads 0xfffffff"));
  // Over and over.
  PackRunOptions o = options();
  o.loop = 0;
  FakeBoard repeated(config());
  alternate(repeated, KAGE_BOARD_PLAYED, fixture().pack.frames.size() * 3);
  CHECK(has(trouble(repeated, o), "PORT: board FAKE: PLAYED goes back from "));
  FakeBoard again(config());
  alternate(again, KAGE_BOARD_LINES, fixture().pack.frames.size() * 3);
  CHECK(has(trouble(again, o), "PORT: board FAKE: LINES goes back from "));
}

TEST_CASE("a line that came out wrong before the core hangs is the first difference") {
  FakeBoard board(config());
  board.hangs_in = 2;
  const Spoil spoil(1, 1, 2, 0);
  board.spoil = [&](std::uint64_t, std::span<std::uint8_t> pixels) { spoil(pixels); };
  const PackVerdict v = play(board);
  REQUIRE(v.first);
  CHECK(v.first->frame == 1);
  CHECK(v.first->line == spoil.line);
  CHECK(v.first->x == 2);
  REQUIRE(!v.notes.empty());
  CHECK(has(v.notes.back(), "behind that the core hangs"));
}

TEST_CASE("a core that hangs at the link's words leaves no board that can be told to be idle") {
  FakeBoard board(config());
  board.memory_words = 4;
  board.hangs_in = 2;
  Link link(board, link_options());
  link.hello();
  const PackVerdict v = play_pack(link, board, "PORT", fixture().folder.path(), fixture().pack, options());
  REQUIRE(v.first);
  CHECK(v.first->frame == 2);
  CHECK(has(v.first->remark, "takes no more of its"));
  CHECK(!board.held());
  CHECK(has(v.notes.back(), "could not be left idle"));
}

TEST_CASE("a screen's counts are told, and a run has frames of one height") {
  FakeBoard board(config());
  board.screen = 640 | 480U << 16U;
  board.underruns = 2;
  board.counted_before = GENERATE(0U, 3U, 65535U, 65530U);  // counters of a board that has run for long turn round
  const PackVerdict v = play(board);
  CHECK(v.same());
  const auto shown = static_cast<std::uint32_t>(std::count_if(
      fixture().pack.frames.begin(), fixture().pack.frames.end(), [](const auto& f) { return f.pixels() > 0; }));
  CHECK(v.screen.shown == shown);
  CHECK(v.screen.underrun_frames == shown);
  CHECK(v.screen.underrun_lines == std::uint64_t{2} * shown);
  CHECK(v.link_good > 50);
  CHECK(v.link_good < 5000);
  CHECK(v.link_bad == 0);
  for (const PackRun& run : cut_into_runs(fixture().pack, v.board, "PORT"))
    for (std::uint64_t i = run.first; i < run.end(); ++i)
      CHECK((fixture().pack.frames[i].pixels() == 0 || fixture().pack.frames[i].status.height == run.height));
}

TEST_CASE("a board that is reset in the middle is said to be") {
  FakeBoard whole(config());
  (void)play(whole);
  for (const std::uint64_t at : {40U, 60U, 90U}) {
    FakeBoard board(config());
    board.resets_at = at;
    const std::string text = trouble(board);
    CHECK(has(text, "PORT: the board was reset while it "));
    CHECK(has(text, ": press no button, check its supply, and run again"));
    CHECK(board.held());
  }
}

TEST_CASE("a board that falls silent is said to be out of reach") {
  FakeBoard board(config());
  int calls = 0;
  PackRunOptions o = options();
  o.wait = [&] { board.silent = ++calls > 5; };
  const std::string text = trouble(board, o);
  CHECK(has(text, "no longer answers"));
  CHECK(has(text, "could not be left idle"));
}

TEST_CASE("what ends a run from outside leaves the board idle") {
  struct Stop {};
  for (int after : {0, 1, 3, 8}) {
    FakeBoard board(config());
    PackRunOptions o = options();
    o.wait = [&] {
      if (after-- == 0) throw Stop{};
    };
    Link link(board, link_options());
    link.hello();
    CHECK_THROWS_AS(play_pack(link, board, "PORT", fixture().folder.path(), fixture().pack, o), Stop);
    CHECK(board.held());
  }
}

TEST_CASE("frames are played over and over") {
  FakeBoard board(config());
  PackRunOptions o = options();
  o.loop = 300'000;
  const PackVerdict v = play(board, o);
  CHECK(v.same());
  REQUIRE(v.loop);
  CHECK(v.loop->repetitions > 20);
  CHECK(v.loop->mismatches == 0);
  CHECK(v.loop->seconds >= 0.3);
  CHECK(!v.loop->left);
}

TEST_CASE("repetitions are counted beyond what a board's counters hold") {
  FakeBoard board(config());
  PackRunOptions o = options();
  o.loop = 0;
  o.enough = [&] { return board.lines_ever() > 500'000; };
  const PackVerdict v = play(board, o);
  CHECK(v.same());
  REQUIRE(v.loop);
  CHECK(v.loop->lines + fixture().lines() == board.lines_ever());
}

TEST_CASE("a board may be left playing") {
  FakeBoard board(config());
  PackRunOptions o = options();
  o.loop = 0;
  o.leave = true;
  int calls = 0;
  o.enough = [&] { return ++calls > 10; };
  const PackVerdict v = play(board, o);
  CHECK(v.same());
  REQUIRE(v.loop);
  CHECK(v.loop->left);
  CHECK(board.playing());
  CHECK(!board.held());
  CHECK(board.control() == (KAGE_BOARD_CONTROL_CHECK_MASK | KAGE_BOARD_CONTROL_LOOP_MASK));
}

TEST_CASE("a repetition that comes out wrong ends the loop") {
  FakeBoard board(config());
  const std::uint64_t whole = fixture().lines();
  const std::uint64_t late = whole + 5 * whole + fixture().lines_before(2) + 1;
  board.spoil = [&](std::uint64_t at, std::span<std::uint8_t> pixels) {
    if (at == late) pixels[0] ^= 8;
  };
  PackRunOptions o = options();
  o.loop = 10'000'000;
  const PackVerdict v = play(board, o);
  REQUIRE(v.first);
  INFO(cosim::describe(*v.first));
  CHECK(v.first->frame == 2);
  CHECK(v.first->line == 1);
  CHECK(has(v.first->remark, "wrong in a repetition"));
  CHECK(has(v.first->remark, "does not repeat"));
  REQUIRE(v.loop);
  CHECK(v.loop->mismatches == 1);
  CHECK(v.loop->repetitions >= 5);
}

TEST_CASE("memory that fails in a repetition is told from a core that does") {
  FakeBoard board(config());
  std::uint64_t reads = 0;
  board.memory_gives = [&](std::uint32_t address, std::uint32_t word) {
    return (board.control() & KAGE_BOARD_CONTROL_LOOP_MASK) != 0 && address == 8 && ++reads == 4 ? word ^ 2U : word;
  };
  PackRunOptions o = options();
  o.loop = 10'000'000;
  const PackVerdict v = play(board, o);
  if (!v.first) return;  // the bit was one that no pixel shows
  REQUIRE(!v.notes.empty());
  CHECK(has(v.notes.back(), "memory gave other words"));
}

TEST_CASE("a core that hangs in a repetition ends the loop") {
  FakeBoard board(config());
  board.hangs_in = fixture().pack.frames.size() * 3;
  PackRunOptions o = options();
  o.loop = 10'000'000;
  const PackVerdict v = play(board, o);
  REQUIRE(v.first);
  CHECK(has(v.first->remark, "the core hangs: repetition "));
}

TEST_CASE("a board is found at its rate, or the rates are named") {
  ConnectOptions o;
  o.link = link_options();
  const auto at = [&](int right) {
    return [=](int baud) {
      auto board = std::make_unique<FakeBoard>(config());
      board->silent = baud != right;
      return board;
    };
  };
  CHECK(connect("PORT", at(3000000), o).baud == 3000000);
  CHECK_THROWS_WITH(connect("PORT", at(115200), o), "PORT: the board answers at 115200 baud; give --baud 115200");
  CHECK_THROWS_WITH(
      connect("PORT", at(0), o),
      "PORT: no kage board answers at 3000000 baud, nor at 115200, 230400, 460800, 921600, 1000000, 2000000: is "
      "it powered and loaded (tools/fpga prints how)?");
}
