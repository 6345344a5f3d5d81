// SPDX-License-Identifier: Apache-2.0
// board_registers against a model by the addresses that the host has (verif/board/generated/board_registers.h): every
// register and window, the way to the core's registers, and AXI4-Lite with a host and a core that stall.
#include "board/generated/board_registers.h"

#include <array>
#include <optional>

#include "Vboard_registers.h"
#include "bench.hpp"

using namespace kage::rtl;

namespace {

using Model = Vboard_registers;
constexpr std::uint32_t kLines = parameter<Model>("LINES");
constexpr std::uint32_t kPixels = parameter<Model>("PIXELS");
constexpr int kOkay = 0, kSlverr = 2;

struct Answer {
  int response;
  std::uint32_t data;
  bool operator==(const Answer&) const = default;
};

/// The core's registers: 64 words, of which those from 0xC0 on answer SLVERR. Held in reset a clock after hold_o.
class Core {
 public:
  std::array<std::uint32_t, 64> words{};
  std::array<std::uint8_t, 64> strobes{};
  int writes = 0, reads = 0;

  static int response(std::uint32_t address) { return address >= 0xC0 ? kSlverr : kOkay; }

  void drive(Dice& dice, Model& top, int stall) {
    const auto go = [&] { return !reset_ && !dice.percent(stall); };
    top.m_axil_awready_i = !aw_ && !b_ && go() ? 1 : 0;
    top.m_axil_wready_i = !w_ && !b_ && go() ? 1 : 0;
    top.m_axil_arready_i = !r_ && !ar_ && go() ? 1 : 0;
    if (aw_ && w_ && !b_ && go()) {
      words[*aw_ / 4] = w_->first;
      strobes[*aw_ / 4] = w_->second;
      ++writes;
      b_ = response(*aw_);
      aw_.reset();
      w_.reset();
    }
    if (ar_ && !r_ && go()) {
      r_ = Answer{response(*ar_), words[*ar_ / 4]};
      ar_.reset();
      ++reads;
    }
    top.m_axil_bvalid_i = b_ ? 1 : 0;
    top.m_axil_bresp_i = static_cast<CData>(b_ ? *b_ : dice.below(4));
    top.m_axil_rvalid_i = r_ ? 1 : 0;
    top.m_axil_rresp_i = static_cast<CData>(r_ ? r_->response : dice.below(4));
    top.m_axil_rdata_i = r_ ? r_->data : static_cast<IData>(dice.bits(32));
  }
  void edge(const Model& top) {
    const bool aw = top.m_axil_awvalid_o && top.m_axil_awready_i;
    const bool w = top.m_axil_wvalid_o && top.m_axil_wready_i;
    const bool ar = top.m_axil_arvalid_o && top.m_axil_arready_i;
    REQUIRE(!(reset_ && (aw || w || ar)));
    // An offer stays until it is taken, unless the core is held.
    if (aw_waits_ && !reset_ && !top.hold_o) REQUIRE((top.m_axil_awvalid_o && top.m_axil_awaddr_o == aw_was_));
    if (w_waits_ && !reset_ && !top.hold_o) REQUIRE((top.m_axil_wvalid_o && top.m_axil_wdata_o == w_was_));
    if (ar_waits_ && !reset_ && !top.hold_o) REQUIRE((top.m_axil_arvalid_o && top.m_axil_araddr_o == ar_was_));
    aw_waits_ = top.m_axil_awvalid_o && !aw;
    w_waits_ = top.m_axil_wvalid_o && !w;
    ar_waits_ = top.m_axil_arvalid_o && !ar;
    aw_was_ = top.m_axil_awaddr_o;
    w_was_ = top.m_axil_wdata_o;
    ar_was_ = top.m_axil_araddr_o;
    if (top.m_axil_bvalid_i && top.m_axil_bready_o) b_.reset();
    if (top.m_axil_rvalid_i && top.m_axil_rready_o) r_.reset();
    if (aw) aw_ = top.m_axil_awaddr_o;
    if (w) w_ = {top.m_axil_wdata_o, top.m_axil_wstrb_o};
    if (ar) ar_ = top.m_axil_araddr_o;
    reset_ = top.hold_o != 0;
    if (reset_) {
      aw_.reset();
      w_.reset();
      ar_.reset();
      b_.reset();
      r_.reset();
    }
  }

 private:
  std::optional<std::uint32_t> aw_, ar_;
  std::optional<std::pair<std::uint32_t, std::uint8_t>> w_;
  std::optional<int> b_;
  std::optional<Answer> r_;
  bool reset_ = true, aw_waits_ = false, w_waits_ = false, ar_waits_ = false;
  std::uint32_t aw_was_ = 0, w_was_ = 0, ar_was_ = 0;
};

class Registers {
 public:
  explicit Registers(Dice& dice) : top(dice), dice_(dice) {
    for (auto& word : signatures) word = static_cast<std::uint32_t>(dice.bits(32));
    for (auto& word : pixels) word = static_cast<std::uint32_t>(dice.bits(32));
    for (auto& word : core.words) word = static_cast<std::uint32_t>(dice.bits(32));
    idle_host();
    top->rst_ni = 0;
    top.settle();
    for (int i = 0; i < 3; ++i) {
      REQUIRE(!top->s_axil_awready_o);
      REQUIRE(!top->s_axil_wready_o);
      REQUIRE(!top->s_axil_arready_o);
      core.drive(dice_, *top, 0);
      top.edge();
    }
    top->rst_ni = 1;
    news();
  }

  /// New values of all that the board says of itself.
  void news() {
    top->playing_i = dice_.bits(1);
    top->memory_ready_i = dice_.bits(1);
    top->irq_i = dice_.bits(1);
    top->load_next_i = static_cast<IData>(dice_.bits(32));
    top->words_crc_i = static_cast<IData>(dice_.bits(32));
    for (SData* port : {&top->played_i, &top->lines_i, &top->mismatches_i, &top->mismatch_place_i, &top->captured_i,
                        &top->frames_shown_i, &top->late_frames_i, &top->underrun_frames_i, &top->underrun_lines_i,
                        &top->link_good_i, &top->link_bad_i, &top->link_overruns_i})
      *port = static_cast<SData>(dice_.bits(16));
  }

  /// The answer to a read.
  Answer read_of(std::uint32_t address) {
    const std::uint32_t word = address & ~3U;
    if (address < 0x100) {
      if (hold) return {kSlverr, 0};
      return {Core::response(address), core.words[address / 4]};
    }
    if (word >= KAGE_BOARD_SIGNATURES && word < KAGE_BOARD_SIGNATURES + 4 * kLines)
      return {kOkay, signatures[(word - KAGE_BOARD_SIGNATURES) / 4]};
    if (word >= KAGE_BOARD_PIXELS && word < KAGE_BOARD_PIXELS + 4 * kPixels)
      return {kOkay, pixels[(word - KAGE_BOARD_PIXELS) / 4]};
    const std::uint32_t control = hold | loop << 1 | paced << 2 | check << 3 | direct << 4;
    switch (word) {
      case KAGE_BOARD_ID:
        return {kOkay, KAGE_BOARD_ID_VALUE};
      case KAGE_BOARD_LAYOUT:
        return {kOkay, KAGE_BOARD_LAYOUT_VALUE};
      case KAGE_BOARD_NAME:
        return {kOkay, static_cast<std::uint32_t>(parameter<Model>("BOARD_NAME"))};
      case KAGE_BOARD_MEMORY_WORDS:
        return {kOkay, static_cast<std::uint32_t>(parameter<Model>("MEMORY_WORDS"))};
      case KAGE_BOARD_SIZES:
        return {kOkay, kLines | kPixels << 16};
      case KAGE_BOARD_SCREEN:
        return {kOkay, static_cast<std::uint32_t>(parameter<Model>("SCREEN_WIDTH")) |
                           static_cast<std::uint32_t>(parameter<Model>("SCREEN_HEIGHT")) << 16};
      case KAGE_BOARD_CONTROL:
        return {kOkay, control};
      case KAGE_BOARD_COMMAND:
        return {kOkay, 0};
      case KAGE_BOARD_STATE:
        return {kOkay, static_cast<std::uint32_t>(top->playing_i | top->memory_ready_i << 1 | top->irq_i << 2)};
      case KAGE_BOARD_LOAD_ADDRESS:
        return {kOkay, top->load_next_i};
      case KAGE_BOARD_LOAD_CRC:
        return {kOkay, top->words_crc_i};
      case KAGE_BOARD_PLAY_ADDRESS:
        return {kOkay, play_address};
      case KAGE_BOARD_PLAY_CRC:
        return {kOkay, top->words_crc_i};
      case KAGE_BOARD_PLAYED:
        return {kOkay, top->played_i};
      case KAGE_BOARD_LINES:
        return {kOkay, top->lines_i};
      case KAGE_BOARD_LOOP_LINES:
        return {kOkay, loop_lines};
      case KAGE_BOARD_MISMATCHES:
        return {kOkay, top->mismatches_i};
      case KAGE_BOARD_MISMATCH_LINE:
        return {kOkay, top->mismatch_place_i};
      case KAGE_BOARD_CAPTURE_LINE:
        return {kOkay, capture_line};
      case KAGE_BOARD_CAPTURED:
        return {kOkay, top->captured_i};
      case KAGE_BOARD_VIDEO_LINES:
        return {kOkay, video_lines};
      case KAGE_BOARD_FRAMES_SHOWN:
        return {kOkay, top->frames_shown_i};
      case KAGE_BOARD_LATE_FRAMES:
        return {kOkay, top->late_frames_i};
      case KAGE_BOARD_UNDERRUN_FRAMES:
        return {kOkay, top->underrun_frames_i};
      case KAGE_BOARD_UNDERRUN_LINES:
        return {kOkay, top->underrun_lines_i};
      case KAGE_BOARD_LINK_GOOD:
        return {kOkay, top->link_good_i};
      case KAGE_BOARD_LINK_BAD:
        return {kOkay, top->link_bad_i};
      case KAGE_BOARD_LINK_OVERRUNS:
        return {kOkay, top->link_overruns_i};
      default:
        return {kSlverr, 0};
    }
  }
  /// A write's answer, with what it does to the board's own registers.
  int write_of(std::uint32_t address, std::uint32_t data) {
    const std::uint32_t word = address & ~3U;
    if (address < 0x100) return hold ? kSlverr : Core::response(address);
    const int response = read_of(address).response;
    if (word >= KAGE_BOARD_SIGNATURES && word < KAGE_BOARD_SIGNATURES + 4 * kLines) expected_signature_ = {word, data};
    switch (word) {
      case KAGE_BOARD_CONTROL:
        hold = data & 1;
        loop = data >> 1 & 1;
        paced = data >> 2 & 1;
        check = data >> 3 & 1;
        direct = data >> 4 & 1;
        break;
      case KAGE_BOARD_COMMAND:
        starts += data & 1;
        stops += data >> 1 & 1;
        break;
      case KAGE_BOARD_LOAD_ADDRESS:
        ++sets;
        load_address = data;
        break;
      case KAGE_BOARD_PLAY_ADDRESS:
        play_address = data;
        break;
      case KAGE_BOARD_LOOP_LINES:
        loop_lines = data & 0xFFFF;
        break;
      case KAGE_BOARD_CAPTURE_LINE:
        capture_line = data & 0xFFFF;
        break;
      case KAGE_BOARD_VIDEO_LINES:
        video_lines = data & 0xFFFF;
        break;
      default:
        break;
    }
    return response;
  }

  /// Requires of all outputs their values while nothing is written.
  void require_settings() {
    REQUIRE(top->hold_o == hold);
    REQUIRE(top->loop_o == loop);
    REQUIRE(top->paced_o == paced);
    REQUIRE(top->check_o == check);
    REQUIRE(top->direct_o == direct);
    REQUIRE(top->play_address_o == play_address);
    REQUIRE(top->loop_lines_o == loop_lines);
    REQUIRE(top->capture_line_o == capture_line);
    REQUIRE(top->video_lines_o == video_lines);
    REQUIRE(starts == started);
    REQUIRE(stops == stopped);
    REQUIRE(sets == set);
    if (sets > 0) REQUIRE(top->load_address_o == load_address);
    REQUIRE(!expected_signature_);
  }

  struct Access {
    std::uint32_t address = 0, data = 0;
    int strobes = 15;
    std::uint64_t clocks = 0;  // from the first clock in which all of it was offered to the answer's, both counted
    Answer answer{};
  };
  /// Does a write, a read, or both at once; `stall` holds back each of the host's channels.
  void run(Access* write, Access* read, int stall, int core_stall) {
    bool aw = write != nullptr, w = aw, ar = read != nullptr, b = aw, r = ar;
    bool aw_on = false, w_on = false, ar_on = false;
    bool b_waits = false, r_waits = false;
    Answer b_was{}, r_was{};
    std::uint64_t write_from = 0, read_from = 0;
    for (int clock = 0; b || r; ++clock) {
      REQUIRE(clock < 3000);
      aw_on = aw_on || (aw && !dice_.percent(stall));
      w_on = w_on || (w && !dice_.percent(stall));
      ar_on = ar_on || (ar && !dice_.percent(stall));
      if (aw_on && aw && w_on && w && write_from == 0) write_from = top.clocks;
      if (ar_on && ar && read_from == 0) read_from = top.clocks;
      top->s_axil_awvalid_i = aw_on && aw ? 1 : 0;
      top->s_axil_awaddr_i = static_cast<SData>(aw_on && aw ? write->address : dice_.bits(16));
      top->s_axil_wvalid_i = w_on && w ? 1 : 0;
      top->s_axil_wdata_i = w_on && w ? write->data : static_cast<IData>(dice_.bits(32));
      top->s_axil_wstrb_i = static_cast<CData>(w_on && w ? write->strobes : dice_.below(16));
      top->s_axil_arvalid_i = ar_on && ar ? 1 : 0;
      top->s_axil_araddr_i = static_cast<SData>(ar_on && ar ? read->address : dice_.bits(16));
      top->s_axil_bready_i = dice_.percent(stall) ? 0 : 1;
      top->s_axil_rready_i = dice_.percent(stall) ? 0 : 1;
      core.drive(dice_, *top, core_stall);
      top.settle();
      if (!b || aw || w) REQUIRE(!top->s_axil_bvalid_o);  // an answer needs both
      if (!r || ar) REQUIRE(!top->s_axil_rvalid_o);
      if (b_waits) REQUIRE((top->s_axil_bvalid_o && top->s_axil_bresp_o == b_was.response));
      if (r_waits) REQUIRE((top->s_axil_rvalid_o && Answer{top->s_axil_rresp_o, top->s_axil_rdata_o} == r_was));
      b_was = {top->s_axil_bresp_o, 0};
      r_was = {top->s_axil_rresp_o, top->s_axil_rdata_o};
      b_waits = top->s_axil_bvalid_o && !top->s_axil_bready_i;
      r_waits = top->s_axil_rvalid_o && !top->s_axil_rready_i;
      const bool took_aw = top->s_axil_awvalid_i && top->s_axil_awready_o;
      const bool took_w = top->s_axil_wvalid_i && top->s_axil_wready_o;
      const bool took_ar = top->s_axil_arvalid_i && top->s_axil_arready_o;
      if (top->s_axil_bvalid_o && top->s_axil_bready_i) {
        b = false;
        write->answer = b_was;
        write->clocks = top.clocks - write_from + 1;
      }
      if (top->s_axil_rvalid_o && top->s_axil_rready_i) {
        r = false;
        read->answer = r_was;
        read->clocks = top.clocks - read_from + 1;
      }
      edge();
      aw = aw && !took_aw;
      w = w && !took_w;
      ar = ar && !took_ar;
    }
    idle_host();
    core.drive(dice_, *top, 100);
    top.settle();
    edge();  // what a write does outside is over by then
  }

  Bench<Model> top;
  Core core;
  std::array<std::uint32_t, kLines> signatures{};
  std::array<std::uint32_t, kPixels> pixels{};
  std::uint32_t hold = 1, loop = 0, paced = 0, check = 0, direct = 0;
  std::uint32_t play_address = 0, loop_lines = 0, capture_line = 0, load_address = 0;
  std::uint32_t video_lines = static_cast<std::uint32_t>(parameter<Model>("SCREEN_HEIGHT"));
  std::uint32_t starts = 0, stops = 0, sets = 0, started = 0, stopped = 0, set = 0;  // wanted, and seen

 private:
  void idle_host() {
    top->s_axil_awvalid_i = 0;
    top->s_axil_wvalid_i = 0;
    top->s_axil_arvalid_i = 0;
    top->s_axil_bready_i = dice_.bits(1);
    top->s_axil_rready_i = dice_.bits(1);
  }
  /// The RAMs read a word a clock.
  void edge() {
    const std::uint32_t place = top->signature_addr_o;
    const std::uint32_t pixel = top->pixel_addr_o;
    const std::uint32_t seen = place < kLines ? signatures[place] : static_cast<std::uint32_t>(dice_.bits(32));
    if (top->signature_wr_en_o) {
      REQUIRE(expected_signature_);
      REQUIRE(KAGE_BOARD_SIGNATURES + 4 * place == expected_signature_->first);
      REQUIRE(top->signature_wr_data_o == expected_signature_->second);
      signatures[place] = top->signature_wr_data_o;
      expected_signature_.reset();
    }
    started += top->start_o;
    stopped += top->stop_o;
    set += top->load_set_o;
    if (top->load_set_o) REQUIRE(top->load_address_o == load_address);
    core.edge(*top);
    top.edge();
    top->signature_rd_data_i = seen;
    top->pixel_rd_data_i = pixel < kPixels ? pixels[pixel] : static_cast<std::uint32_t>(dice_.bits(32));
    top.settle();
  }

  Dice& dice_;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> expected_signature_;
};

std::uint32_t some_address(Dice& dice) {
  const auto within = [&](std::uint32_t from, std::uint32_t to) {
    return from + static_cast<std::uint32_t>(dice.below(static_cast<int>(to - from)));
  };
  // The lowest two bits of an address say nothing to the board's own.
  switch (dice.below(6)) {
    case 0:
      return within(0, 0x100) & ~3U;
    case 1:
    case 2:
      return within(KAGE_BOARD_ID, KAGE_BOARD_LINK_OVERRUNS + 4);
    case 3:
      return within(KAGE_BOARD_SIGNATURES, KAGE_BOARD_SIGNATURES + 4 * kLines);
    case 4:
      return within(KAGE_BOARD_PIXELS, KAGE_BOARD_PIXELS + 4 * kPixels);
    default: {
      static constexpr std::uint32_t kEdges[] = {0xFC,
                                                 0x100,
                                                 KAGE_BOARD_LINK_OVERRUNS + 3,
                                                 KAGE_BOARD_LINK_OVERRUNS + 4,
                                                 KAGE_BOARD_SIGNATURES - 4,
                                                 KAGE_BOARD_SIGNATURES + 4 * kLines,
                                                 KAGE_BOARD_PIXELS - 4,
                                                 KAGE_BOARD_PIXELS + 4 * kPixels,
                                                 0x8000 + KAGE_BOARD_CONTROL,
                                                 0xFFFC};
      return dice.percent(60) ? kEdges[dice.below(10)] : static_cast<std::uint32_t>(dice.bits(16)) & ~3U;
    }
  }
}

std::uint32_t some_data(Dice& dice, std::uint32_t address) {
  const auto data = static_cast<std::uint32_t>(dice.bits(32));
  // Mostly the core is not held, so that the way to it is seen.
  return (address & ~3U) == KAGE_BOARD_CONTROL && dice.percent(70) ? data & ~1U : data;
}

bool is_own(std::uint32_t address) { return address >= 0x100; }

}  // namespace

TEST_CASE("board_registers has what board.yaml has, one access at a time", "[board_registers]") {
  each_seed(60, [](Dice& dice) {
    Registers board(dice);
    board.require_settings();
    int core_writes = 0, core_reads = 0;
    for (int i = 0; i < 300; ++i) {
      board.news();
      const int stall = dice.percent(50) ? 0 : stall_percent(dice);
      const int core_stall = stall_percent(dice);
      Registers::Access access{.address = some_address(dice), .strobes = dice.below(16)};
      access.data = some_data(dice, access.address);
      CAPTURE(access.address, access.data, board.hold);
      const bool to_core = access.address < 0x100 && board.hold == 0;
      if (dice.percent(50)) {
        const int response = board.write_of(access.address, access.data);
        board.run(&access, nullptr, stall, core_stall);
        REQUIRE(access.answer.response == response);
        if (to_core) {
          ++core_writes;
          REQUIRE(board.core.words[access.address / 4] == access.data);
          REQUIRE(board.core.strobes[access.address / 4] == access.strobes);
        }
        if (stall == 0 && is_own(access.address)) REQUIRE(access.clocks == 4);
        if (stall == 0 && to_core && core_stall == 0) REQUIRE(access.clocks == 6);
      } else {
        const Answer answer = board.read_of(access.address);
        board.run(nullptr, &access, stall, core_stall);
        REQUIRE(access.answer == answer);
        if (to_core) ++core_reads;
        const bool ram = access.answer.response == kOkay && access.address >= KAGE_BOARD_SIGNATURES;
        if (stall == 0 && is_own(access.address)) REQUIRE(access.clocks == (ram ? 4U : 3U));
        if (stall == 0 && to_core && core_stall == 0) REQUIRE(access.clocks == 5);
      }
      REQUIRE(board.core.writes == core_writes);
      REQUIRE(board.core.reads == core_reads);
      board.require_settings();
    }
  });
}

TEST_CASE("board_registers writes and reads at once", "[board_registers]") {
  each_seed(60, [](Dice& dice) {
    Registers board(dice);
    for (int i = 0; i < 300; ++i) {
      board.news();
      const int stall = dice.percent(60) ? 0 : stall_percent(dice);
      Registers::Access write{.address = some_address(dice)}, read{.address = some_address(dice)};
      if (dice.percent(30)) {  // of one window, where the write has the RAM's address for a clock
        write.address = KAGE_BOARD_SIGNATURES + 4 * static_cast<std::uint32_t>(dice.below(kLines));
        read.address = KAGE_BOARD_SIGNATURES + 4 * static_cast<std::uint32_t>(dice.below(kLines));
      }
      write.data = some_data(dice, write.address);
      CAPTURE(write.address, write.data, read.address, board.hold);
      // A read of what is written at that time has the old or the new.
      const Answer before = board.read_of(read.address);
      const int response = board.write_of(write.address, write.data);
      const Answer after = write.address / 4 == read.address / 4 && read.address < KAGE_BOARD_SIGNATURES + 4 * kLines &&
                                   (read.address < 0x100 || read.address >= KAGE_BOARD_SIGNATURES) &&
                                   before.response == kOkay
                               ? Answer{kOkay, write.data}
                               : board.read_of(read.address);
      board.run(&write, &read, stall, stall_percent(dice));
      REQUIRE(write.answer.response == response);
      CAPTURE(read.answer.response, read.answer.data, before.data, after.data);
      REQUIRE((read.answer == before || read.answer == after ||
               (read.address < 0x100 && before.response == after.response && before.response == kSlverr &&
                read.answer == Answer{kSlverr, write.data})));
      board.require_settings();
    }
  });
}
