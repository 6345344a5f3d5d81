// SPDX-License-Identifier: Apache-2.0
// uart_link, with the host's Link at the other end of a line that stalls, loses, doubles, corrupts and inserts bytes.
#include <array>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "Vuart_link2.h"
#include "Vuart_link4.h"
#include "bench.hpp"
#include "board/link.hpp"
#include "board/link_frame.hpp"

using namespace kage::rtl;
using kage::board::encoded;
using kage::board::Frame;
using kage::board::FrameKind;
using kage::board::FrameReader;
using kage::board::Link;
using kage::board::LinkError;
using kage::board::LinkFailure;

namespace {

enum class Damage { none, lost, doubled, corrupted, inserted, any };

/// Damage whose CRC fits by chance (docs/link.md, "What follows"): no link of 16 bits sees it, so what it does
/// is no matter of the tests.
struct Undetected {};

/// One direction of the line.
struct Wire {
  std::deque<std::uint8_t> bytes;
  Damage damage = Damage::none;
  int apart = 0;  // damages are so many bytes apart, on the average
  int left = 0;   // bytes until the next
  int damages = 0;
  bool cut = false;  // nothing passes

  void put(Dice& dice, std::uint8_t byte) {
    if (const auto frame = at_sender_.take(byte)) sent_.insert(body_of(*frame));
    if (cut) return;
    if (damage == Damage::none || left-- > 0) {
      arrive(byte);
      return;
    }
    left = dice.below(2 * apart);
    ++damages;
    const auto other = static_cast<std::uint8_t>(dice.percent(30) ? (dice.percent(50) ? 0x7E : 0x7D) : dice.bits(8));
    const Damage now = damage != Damage::any ? damage : static_cast<Damage>(dice.between(1, 4));
    if (now == Damage::lost) return;
    if (now == Damage::doubled) arrive(byte);
    if (now == Damage::inserted) arrive(other);
    if (now != Damage::corrupted)
      arrive(byte);
    else
      arrive(other != byte ? other : static_cast<std::uint8_t>(byte ^ 1));
  }

 private:
  using Body = std::vector<std::uint8_t>;
  FrameReader at_sender_, at_taker_;
  std::set<Body> sent_;

  static Body body_of(const Frame& frame) {
    Body body{static_cast<std::uint8_t>(frame.kind), frame.sequence};
    body.insert(body.end(), frame.payload.begin(), frame.payload.end());
    return body;
  }

  void arrive(std::uint8_t byte) {
    bytes.push_back(byte);
    const auto frame = at_taker_.take(byte);
    if (frame && !sent_.contains(body_of(*frame))) throw Undetected();
  }
};

/// The board: the model, an AXI4-Lite slave whose addresses from 0xF000 on refuse, a taker of the stream. A microsecond
/// of its clock is a clock.
template <class Model = Vuart_link4>
class Board : public kage::board::Transport {
 public:
  explicit Board(Dice& dice) : dice_(dice), top(dice) {
    top->rx_valid_i = 0;
    pace = dice.between(1, 6);
    stall_ = dice.percent(50) ? 0 : dice.between(1, 60);
    sink_stall_ = dice.percent(50) ? 0 : dice.between(1, 60);
    for (auto& word : memory) word = static_cast<std::uint32_t>(dice.bits(32));
    quiet();
  }

  void write(std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) to_board.put(dice_, byte);
  }
  std::size_t read(std::span<std::uint8_t> bytes, std::uint64_t deadline) override {
    while (to_host.bytes.empty()) {
      if (now() >= deadline) return 0;
      clock();
    }
    std::size_t n = 0;
    for (; n < bytes.size() && !to_host.bytes.empty(); ++n) {
      bytes[n] = to_host.bytes.front();
      to_host.bytes.pop_front();
    }
    return n;
  }
  std::uint64_t now() override { return top.clocks; }

  void reset() {
    top->rst_ni = 0;
    top->rx_valid_i = 0;
    quiet();
    for (int i = 0; i < 3; ++i) top.edge();
    top->rst_ni = 1;
    aw_held_ = w_held_ = ar_held_ = false;
    offered_aw_ = offered_ar_ = offered_t_ = false;
  }

  void clock() {
    const bool byte = !to_board.bytes.empty() && (pace == 1 || dice_.below(pace) == 0);
    top->rx_valid_i = byte ? 1 : 0;
    top->rx_data_i = byte ? to_board.bytes.front() : static_cast<std::uint8_t>(dice_.bits(8));
    top->tx_ready_i = !tx_blocked && (pace == 1 || dice_.below(pace) == 0) ? 1 : 0;
    top->m_axil_awready_i = !aw_held_ && !stalls() ? 1 : 0;
    top->m_axil_wready_i = !w_held_ && !stalls() ? 1 : 0;
    top->m_axil_arready_i = !ar_held_ && !stalls() ? 1 : 0;
    if (aw_held_ && w_held_ && !top->m_axil_bvalid_i && !stalls()) {
      top->m_axil_bvalid_i = 1;
      top->m_axil_bresp_i = address_ >= 0xF000 ? static_cast<CData>(dice_.between(2, 3)) : 0;
    }
    if (ar_held_ && !top->m_axil_rvalid_i && !stalls()) {
      top->m_axil_rvalid_i = 1;
      top->m_axil_rresp_i = read_address_ >= 0xF000 ? static_cast<CData>(dice_.between(2, 3)) : 0;
      top->m_axil_rdata_i = memory[read_address_ / 4];
    }
    top->m_axis_tready_i = !sink_blocked && !dice_.percent(sink_stall_) ? 1 : 0;
    top.settle();
    if (byte) {
      REQUIRE(top->rx_ready_o);
      to_board.bytes.pop_front();
    }
    // An offer stays until it is taken.
    if (offered_tx_) REQUIRE((top->tx_valid_o && top->tx_data_o == tx_data_));
    if (offered_aw_) REQUIRE((top->m_axil_awvalid_o && top->m_axil_awaddr_o == aw_data_));
    if (offered_ar_) REQUIRE((top->m_axil_arvalid_o && top->m_axil_araddr_o == ar_data_));
    if (offered_t_) REQUIRE((top->m_axis_tvalid_o && top->m_axis_tdata_o == t_data_));
    offered_tx_ = top->tx_valid_o && !top->tx_ready_i;
    tx_data_ = top->tx_data_o;
    offered_aw_ = top->m_axil_awvalid_o && !top->m_axil_awready_i;
    aw_data_ = top->m_axil_awaddr_o;
    offered_ar_ = top->m_axil_arvalid_o && !top->m_axil_arready_i;
    ar_data_ = top->m_axil_araddr_o;
    offered_t_ = top->m_axis_tvalid_o && !top->m_axis_tready_i;
    t_data_ = top->m_axis_tdata_o;

    if (top->tx_valid_o && top->tx_ready_i) to_host.put(dice_, top->tx_data_o);
    if (top->m_axis_tvalid_o && top->m_axis_tready_i) streamed.push_back(top->m_axis_tdata_o);
    const bool answered = top->m_axil_bvalid_i && top->m_axil_bready_o;
    if (answered) {
      REQUIRE((aw_held_ && w_held_));
      written.emplace_back(address_, data_);
      memory[address_ / 4] = data_;
      aw_held_ = w_held_ = false;
    }
    if (top->m_axil_awvalid_o && top->m_axil_awready_i) {
      aw_held_ = true;
      address_ = top->m_axil_awaddr_o;
    }
    if (top->m_axil_wvalid_o && top->m_axil_wready_i) {
      w_held_ = true;
      data_ = top->m_axil_wdata_o;
      REQUIRE(top->m_axil_wstrb_o == 15);
    }
    const bool gave = top->m_axil_rvalid_i && top->m_axil_rready_o;
    if (gave) ar_held_ = false;
    if (top->m_axil_arvalid_o && top->m_axil_arready_i) {
      ar_held_ = true;
      read_address_ = top->m_axil_araddr_o;
    }
    top.edge();
    if (answered) top->m_axil_bvalid_i = 0;
    if (gave) top->m_axil_rvalid_i = 0;
  }

  void clocks(int n) {
    for (int i = 0; i < n; ++i) clock();
  }

  /// Sends a frame as it is, lets it arrive and be answered, and returns what came.
  std::vector<Frame> exchange(const std::vector<std::uint8_t>& bytes, int extra = 400) {
    write(bytes);
    while (!to_board.bytes.empty()) clock();
    clocks(extra);
    std::vector<Frame> frames;
    while (!to_host.bytes.empty()) {
      if (auto frame = reader_.take(to_host.bytes.front())) frames.push_back(*frame);
      to_host.bytes.pop_front();
    }
    return frames;
  }

 private:
  Dice& dice_;
  int stall_ = 0, sink_stall_ = 0;
  bool aw_held_ = false, w_held_ = false, ar_held_ = false;
  std::uint32_t address_ = 0, data_ = 0, read_address_ = 0;
  bool offered_tx_ = false, offered_aw_ = false, offered_ar_ = false, offered_t_ = false;
  std::uint32_t tx_data_ = 0, aw_data_ = 0, ar_data_ = 0, t_data_ = 0;
  FrameReader reader_;

  bool stalls() { return stall_ > 0 && dice_.percent(stall_); }
  void quiet() {
    top->tx_ready_i = top->m_axil_awready_i = top->m_axil_wready_i = top->m_axil_bvalid_i = 0;
    top->m_axil_arready_i = top->m_axil_rvalid_i = top->m_axis_tready_i = 0;
    offered_tx_ = false;
  }

 public:
  Bench<Model> top;
  Wire to_board, to_host;
  int pace = 1;
  bool sink_blocked = false, tx_blocked = false;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> written;
  std::vector<std::uint32_t> streamed;
  std::array<std::uint32_t, 0x4000> memory{};
};

std::vector<std::uint32_t> some_words(Dice& dice, int most) {
  std::vector<std::uint32_t> words(static_cast<std::size_t>(dice.between(1, most)));
  for (auto& word : words) {
    word = static_cast<std::uint32_t>(dice.bits(32));
    if (dice.percent(20)) word = dice.percent(50) ? 0x7E7E7D7E : 0x7D5E5D7D;  // flags and escapes
  }
  return words;
}

/// The words that must have arrived.
struct Truth {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> written;
  std::vector<std::uint32_t> streamed;
  std::array<std::uint32_t, 0x4000> memory{};
};

/// One random transfer.
void transfer(Dice& dice, Link& link, Truth& truth, int most) {
  const std::vector<std::uint32_t> words = some_words(dice, most);
  const auto address = static_cast<std::uint32_t>(4 * dice.below(0x3C00 - most));
  switch (dice.below(5)) {
    case 0:
    case 1: {
      const bool same = dice.percent(30);
      link.write(address, words, same);
      for (std::size_t i = 0; i < words.size(); ++i) {
        const auto at = address + (same ? 0 : static_cast<std::uint32_t>(4 * i));
        truth.written.emplace_back(at, words[i]);
        truth.memory[at / 4] = words[i];
      }
      break;
    }
    case 2:
    case 3:
      link.stream(words);
      truth.streamed.insert(truth.streamed.end(), words.begin(), words.end());
      break;
    default: {
      const auto from = truth.written.empty() || dice.percent(50) ? address : truth.written.back().first;
      const std::size_t count = std::min(words.size(), std::size_t{(0xF000 - from) / 4});
      const auto read = link.read(from, count);
      REQUIRE(read.size() == count);
      for (std::size_t i = 0; i < count; ++i) REQUIRE(read[i] == truth.memory[from / 4 + i]);
    }
  }
}

template <class Model>
void require_exact(const Board<Model>& board, const Truth& truth) {
  REQUIRE(board.written == truth.written);
  REQUIRE(board.streamed == truth.streamed);
}

LinkFailure failure_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const LinkError& e) {
    UNSCOPED_INFO(e.what());
    return e.failure;
  }
  FAIL("nothing was thrown");
  return {};
}

template <class Model>
void exact_test() {
  each_seed(12, [](Dice& dice) {
    Board<Model> board(dice);
    Link link(board, {20'000, 3, 0});
    link.hello();
    Truth truth;
    truth.memory = board.memory;
    for (int i = 0; i < 60; ++i) transfer(dice, link, truth, dice.percent(20) ? 150 : 10);
    link.flush();
    require_exact(board, truth);
    REQUIRE(link.statistics().resent == 0);
    REQUIRE(link.statistics().answers_damaged == 0);
    REQUIRE(board.top->bad_frames_o == 0);
    REQUIRE(board.top->good_frames_o == link.statistics().sent);
    REQUIRE(board.top->overruns_o == 0);
    REQUIRE(!board.top->fresh_o);
  });
}

/// Rounds on a line that damages. One that meets undetected damage ends there. In 8 rounds both ways some 8000 bodies
/// are damaged, and each passes with 2^-16: four passing have a chance of 1e-5.
template <class Body>
void each_damaged(int rounds, Body body) {
  int undetected = 0;
  each_seed(rounds, [&](Dice& dice) {
    try {
      body(dice);
    } catch (const Undetected&) {
      ++undetected;
    }
  });
  REQUIRE(undetected <= 3);
}

void damage_test(Damage damage, bool up) {
  each_damaged(4, [&](Dice& dice) {
    Board<> board(dice);
    Link link(board, {3'000, 40, 0});
    link.hello();
    Truth truth;
    truth.memory = board.memory;
    Wire& wire = up ? board.to_board : board.to_host;
    wire.damage = damage;
    wire.apart = dice.between(40, 120);
    while (wire.damages < 250) transfer(dice, link, truth, 5);
    link.flush();
    require_exact(board, truth);
    REQUIRE(board.top->overruns_o == 0);
    // Damage was seen: but for a doubled or inserted flag between frames every one ends a frame badly.
    if (up)
      REQUIRE(board.top->bad_frames_o > 50);
    else
      REQUIRE(link.statistics().answers_damaged > 50);
  });
}

Frame stream_frame(int sequence, const std::vector<std::uint32_t>& words) {
  Frame frame{FrameKind::stream, static_cast<std::uint8_t>(sequence & 0xFF), {}};
  for (const std::uint32_t word : words) kage::board::put_word(frame.payload, word);
  return frame;
}

/// Limit, done, session and flags of the last ACK.
struct Ack {
  int expected, limit, done, session, flags;
};
Ack last_ack(const std::vector<Frame>& frames) {
  REQUIRE(!frames.empty());
  const Frame& f = frames.back();
  REQUIRE(f.kind == FrameKind::ack);
  REQUIRE(f.payload.size() == 4);
  return {f.sequence, f.payload[0], f.payload[1], f.payload[2], f.payload[3]};
}

}  // namespace

TEST_CASE("Everything arrives once and in order, with four slots and with two", "[uart_link]") {
  exact_test<Vuart_link4>();
  exact_test<Vuart_link2>();
}

TEST_CASE("Bytes lost on the way to the board", "[uart_link]") { damage_test(Damage::lost, true); }
TEST_CASE("Bytes doubled on the way to the board", "[uart_link]") { damage_test(Damage::doubled, true); }
TEST_CASE("Bytes corrupted on the way to the board", "[uart_link]") { damage_test(Damage::corrupted, true); }
TEST_CASE("Bytes inserted on the way to the board", "[uart_link]") { damage_test(Damage::inserted, true); }
TEST_CASE("Bytes lost on the way to the host", "[uart_link]") { damage_test(Damage::lost, false); }
TEST_CASE("Bytes doubled on the way to the host", "[uart_link]") { damage_test(Damage::doubled, false); }
TEST_CASE("Bytes corrupted on the way to the host", "[uart_link]") { damage_test(Damage::corrupted, false); }
TEST_CASE("Bytes inserted on the way to the host", "[uart_link]") { damage_test(Damage::inserted, false); }

TEST_CASE("Damage of all sorts, both ways at once", "[uart_link]") {
  each_damaged(8, [](Dice& dice) {
    Board<Vuart_link2> board(dice);
    Link link(board, {3'000, 60, 0});
    link.hello();
    Truth truth;
    truth.memory = board.memory;
    for (Wire* wire : {&board.to_board, &board.to_host}) {
      wire->damage = Damage::any;
      wire->apart = dice.between(50, 150);
    }
    while (board.to_board.damages < 250) transfer(dice, link, truth, 5);
    link.flush();
    require_exact(board, truth);
    REQUIRE(board.to_host.damages > 50);
    REQUIRE(board.top->overruns_o == 0);
  });
}

TEST_CASE("A board that is reset is told from one that is silent", "[uart_link]") {
  each_seed(10, [](Dice& dice) {
    Board<> board(dice);
    Link link(board, {3'000, 5, 0});
    link.hello();
    REQUIRE(!board.top->fresh_o);
    Truth truth;
    truth.memory = board.memory;
    for (int i = dice.below(20); i > 0; --i) transfer(dice, link, truth, 20);
    if (dice.percent(50)) link.flush();
    board.clocks(dice.below(500));
    board.reset();
    REQUIRE(board.top->fresh_o);
    if (dice.percent(50)) board.to_host.bytes.clear();  // the ACK of the reset is lost
    const std::size_t before = board.streamed.size();
    REQUIRE(failure_of([&] {
              link.stream(std::vector<std::uint32_t>{1, 2, 3});
              link.flush();
            }) == LinkFailure::reset_in_the_middle);
    board.clocks(2000);
    REQUIRE(board.streamed.size() == before);      // a fresh board executes nothing
    REQUIRE_THROWS_AS(link.flush(), kage::Error);  // and hello() comes first
    link.hello();
    truth.memory = board.memory;
    truth.written = board.written;
    truth.streamed = board.streamed;
    for (int i = 0; i < 10; ++i) transfer(dice, link, truth, 20);
    link.flush();
    require_exact(board, truth);

    // Another host's HELLO ends the session, too.
    Link other(board, {3'000, 5, 0});
    other.hello();
    if (other.session() == link.session()) other.hello();  // by chance: the next number is another
    REQUIRE(failure_of([&] {
              link.flush();
              link.stream(std::vector<std::uint32_t>{1});
              link.flush();
            }) == LinkFailure::reset_in_the_middle);
  });
}

TEST_CASE("Silence is no answer, within the tries", "[uart_link]") {
  each_seed(5, [](Dice& dice) {
    for (const bool up : {true, false}) {
      Board<> board(dice);
      Link link(board, {3'000, 5, 0});
      Wire& wire = up ? board.to_board : board.to_host;
      wire.cut = true;
      REQUIRE(failure_of([&] { link.hello(); }) == LinkFailure::no_answer);
      REQUIRE(board.now() < 18'000);
      wire.cut = false;
      link.hello();
      wire.cut = true;
      const std::uint64_t begun = board.now();
      REQUIRE(failure_of([&] {
                link.stream(std::vector<std::uint32_t>(3));
                link.flush();
              }) == LinkFailure::no_answer);
      REQUIRE(board.now() - begun < 21'000);
      wire.cut = false;
      link.hello();
      wire.cut = true;
      REQUIRE(failure_of([&] { (void)link.read(0, 3); }) == LinkFailure::no_answer);
    }
  });
}

TEST_CASE("An address that refuses is a bus error, of this session alone", "[uart_link]") {
  each_seed(10, [](Dice& dice) {
    Board<> board(dice);
    Link link(board, {3'000, 5, 0});
    link.hello();
    link.write(0xEFF8, std::vector<std::uint32_t>{1, 2});
    link.flush();
    REQUIRE(!board.top->axi_error_o);
    REQUIRE(failure_of([&] {
              link.write(0xEFFC, std::vector<std::uint32_t>{3, 4});
              link.flush();
            }) == LinkFailure::bus_error);
    REQUIRE(board.top->axi_error_o);
    link.hello();
    REQUIRE(!board.top->axi_error_o);
    REQUIRE(link.read(0xEFF8, 2) == std::vector<std::uint32_t>{1, 3});
    REQUIRE(failure_of([&] { (void)link.read(0xEFFC, 2); }) == LinkFailure::bus_error);
    link.hello();
    link.flush();
    REQUIRE_THROWS_AS(link.write(2, std::vector<std::uint32_t>{1}), kage::Error);
    REQUIRE_THROWS_AS(link.write(0xFFFC, std::vector<std::uint32_t>{1, 2}), kage::Error);
    REQUIRE_THROWS_AS(link.read(0x10000, 1), kage::Error);

    // Addresses beyond 16 bits, which this host does not send.
    const std::size_t before = board.written.size();
    auto ack = last_ack(board.exchange(encoded({FrameKind::hello, 9, {}})));
    REQUIRE(ack.flags == 0);
    Frame far{FrameKind::write, 10, {}};
    for (const std::uint32_t word : {0x10000U, 5U}) kage::board::put_word(far.payload, word);
    ack = last_ack(board.exchange(encoded(far)));
    REQUIRE(ack.done == 11);
    REQUIRE(ack.flags == kage::board::kAxiError);
    REQUIRE(board.written.size() == before);
    far = {FrameKind::read, 11, {0, 0, 0, 0x80, 3}};
    const auto frames = board.exchange(encoded(far), 2000);
    bool answered = false;
    for (const Frame& f : frames)
      if (f.kind == FrameKind::data) {
        answered = true;
        REQUIRE(f.sequence == 11);
        REQUIRE(f.payload == std::vector<std::uint8_t>{kage::board::kAxiError});
      }
    REQUIRE(answered);
  });
}

TEST_CASE("A host that ignores its credits loses its frame, and nothing else", "[uart_link]") {
  each_seed(10, [](Dice& dice) {
    Board<> board(dice);
    const int slots = parameter<Vuart_link4>("SLOTS");
    board.sink_blocked = true;
    const int first = dice.below(256);
    auto ack = last_ack(board.exchange(encoded({FrameKind::hello, static_cast<std::uint8_t>(first), {}})));
    REQUIRE(ack.expected == ((first + 1) & 0xFF));
    REQUIRE(ack.limit == ((first + 1 + slots) & 0xFF));
    REQUIRE(ack.session == first);
    std::vector<std::vector<std::uint32_t>> sent;
    std::vector<std::uint8_t> burst;
    const int count = slots + dice.between(1, 5);
    for (int i = 1; i <= count; ++i) {
      sent.push_back(some_words(dice, dice.percent(20) ? 63 : 5));
      const auto line = encoded(stream_frame(first + i, sent.back()));
      burst.insert(burst.end(), line.begin(), line.end());
    }
    ack = last_ack(board.exchange(burst));
    REQUIRE(board.top->overrun_o);
    REQUIRE(board.top->overruns_o == 1);
    REQUIRE(ack.expected == ((first + 1 + slots) & 0xFF));
    REQUIRE(ack.limit == ack.expected);
    REQUIRE(ack.flags == (kage::board::kOverrun | kage::board::kDropped));
    board.sink_blocked = false;
    board.clocks(20'000);
    std::vector<std::uint32_t> all;
    for (int i = 0; i < slots; ++i)
      all.insert(all.end(), sent[static_cast<std::size_t>(i)].begin(), sent[static_cast<std::size_t>(i)].end());
    REQUIRE(board.streamed == all);
    const auto& next = sent[static_cast<std::size_t>(slots)];
    (void)board.exchange(encoded(stream_frame(first + slots + 1, next)), 5000);
    all.insert(all.end(), next.begin(), next.end());
    REQUIRE(board.streamed == all);

    // The host says so; the next session is clean.
    Link link(board, {3'000, 5, 0});
    link.hello();
    REQUIRE(!board.top->overrun_o);
    board.sink_blocked = true;
    // All that there is room for, and one more, behind the link's back.
    const int session = board.exchange(encoded({FrameKind::poll, 0, {}})).back().payload[2];
    for (int i = 1; i <= slots + 1; ++i) (void)board.exchange(encoded(stream_frame(session + i, {7})));
    (void)board.exchange(encoded({FrameKind::poll, 0, {}}));
    REQUIRE(failure_of([&] {
              link.stream(std::vector<std::uint32_t>{7});
              link.flush();
            }) == LinkFailure::overrun);
  });
}

TEST_CASE("A board that answers and executes nothing is stalled, and not for ever", "[uart_link]") {
  each_seed(5, [](Dice& dice) {
    Board<> board(dice);
    Link link(board, {3'000, 5, 50'000});
    link.hello();
    board.sink_blocked = true;
    REQUIRE(failure_of([&] {
              for (int i = 0; i < 10; ++i) link.stream(std::vector<std::uint32_t>(3));
            }) == LinkFailure::stalled);
    REQUIRE(board.now() > 50'000);
    // The transfers that this session sent are executed before the next begins.
    REQUIRE(failure_of([&] { link.hello(); }) == LinkFailure::stalled);
    board.sink_blocked = false;
    link.hello();
    const std::size_t before = board.streamed.size();
    REQUIRE(before == 12);
    board.clocks(2000);
    REQUIRE(board.streamed.size() == before);
  });
}

TEST_CASE("Whatever came before, a flag and a frame are understood", "[uart_link]") {
  each_seed(40, [](Dice& dice) {
    Board<> board(dice);
    std::vector<std::uint8_t> garbage;
    for (int n = dice.below(700); n > 0; --n)
      garbage.push_back(static_cast<std::uint8_t>(dice.percent(10) ? 0x7D + dice.below(2) : dice.bits(8)));
    auto line = encoded({FrameKind::hello, 200, {}});
    garbage.insert(garbage.end(), line.begin(), line.end());
    Ack ack = last_ack(board.exchange(garbage, 2000));
    REQUIRE(ack.expected == 201);
    REQUIRE(ack.session == 200);
    REQUIRE(ack.flags == 0);
    // Frames whose CRC is right and whose form is not, or which are none of the host's.
    const unsigned bad = board.top->bad_frames_o;
    const std::vector<Frame> wrong{{FrameKind::write, 201, {0, 0, 0}},
                                   {FrameKind::write, 201, {0, 0, 0, 0, 1}},
                                   {FrameKind::write_same, 201, {}},
                                   {FrameKind::stream, 201, {1, 2, 3}},
                                   {FrameKind::read, 201, {0, 0, 0, 0, 0}},
                                   {FrameKind::read, 201, {0, 0, 0, 0, 63}},
                                   {FrameKind::read, 201, {0, 0, 0, 0}},
                                   {FrameKind::read, 201, {0, 0, 0, 0, 1, 0}},
                                   {FrameKind::hello, 7, {0}},
                                   {FrameKind::poll, 7, {0}},
                                   {FrameKind::ack, 201, {}},
                                   {static_cast<FrameKind>(0x42), 201, {0, 0, 0, 0}}};
    for (const Frame& frame : wrong) {
      ack = last_ack(board.exchange(encoded(frame)));
      REQUIRE(ack.expected == 201);
      REQUIRE(ack.flags == kage::board::kDropped);
    }
    REQUIRE(board.top->bad_frames_o == bad + wrong.size());
    // A body of more than 256 bytes, of any length, whose CRC is right: 260 bytes are no length of a frame, modulo
    // anything.
    for (const std::size_t words : {63, 64, 65, 128, 192, 600}) {
      std::vector<std::uint8_t> body{0x03, 201};
      for (std::size_t i = 0; i < words; ++i) body.insert(body.end(), {1, 2, 3, 4});
      std::uint16_t crc = 0xFFFF;
      for (const std::uint8_t byte : body) {
        crc ^= byte;
        for (int i = 0; i < 8; ++i) crc = static_cast<std::uint16_t>(crc >> 1 ^ ((crc & 1) != 0 ? 0x8408 : 0));
      }
      body.push_back(static_cast<std::uint8_t>(~crc & 0xFF));
      body.push_back(static_cast<std::uint8_t>(~crc >> 8 & 0xFF));
      std::vector<std::uint8_t> long_line{0x7E};
      for (const std::uint8_t byte : body) {
        if (byte == 0x7E || byte == 0x7D) long_line.push_back(0x7D);
        long_line.push_back(byte == 0x7E || byte == 0x7D ? byte ^ 0x20 : byte);
      }
      long_line.push_back(0x7E);
      ack = last_ack(board.exchange(long_line, 3000));
      REQUIRE(ack.expected == 202);  // the first is of 256 bytes
      REQUIRE(board.streamed.size() == 63);
    }
    // Empty bodies are answered by nothing; an escape before a flag gives the frame up.
    REQUIRE(board.exchange({0x7E, 0x7E, 0x7E}).empty());
    line = encoded(stream_frame(202, {1}));
    line.back() = 0x7D;
    line.push_back(0x7E);
    REQUIRE(last_ack(board.exchange(line)).expected == 202);
    REQUIRE(last_ack(board.exchange(encoded(stream_frame(202, {1})))).expected == 203);
    // A byte may be escaped that need not be, and look like an escape then.
    std::vector<std::uint8_t> escaped;
    for (const std::uint8_t byte : encoded(stream_frame(203, {0x5D5D5D5D, 2}))) {
      if (byte == 0x5D) escaped.push_back(0x7D);
      escaped.push_back(byte == 0x5D ? 0x7D : byte);
    }
    REQUIRE(last_ack(board.exchange(escaped)).expected == 204);
  });
}

TEST_CASE("Until the first HELLO nothing is executed, and an ACK follows reset", "[uart_link]") {
  each_seed(5, [](Dice& dice) {
    Board<> board(dice);
    Ack ack = last_ack(board.exchange({}));
    REQUIRE(ack.flags == kage::board::kFresh);
    ack = last_ack(board.exchange(encoded(stream_frame(0, {1, 2}))));
    REQUIRE(ack.expected == 0);
    REQUIRE(ack.flags == (kage::board::kFresh | kage::board::kDropped));
    ack = last_ack(board.exchange(encoded({FrameKind::poll, 0, {}})));
    REQUIRE(ack.flags == kage::board::kFresh);
    REQUIRE(board.streamed.empty());
  });
}

TEST_CASE("A flood of bad frames does not keep an answer back", "[uart_link]") {
  each_seed(5, [](Dice& dice) {
    Board<> board(dice);
    board.pace = 3;
    (void)board.exchange(encoded({FrameKind::hello, 0, {}}));
    auto bytes = encoded({FrameKind::read, 1, {0, 0, 0, 0, 2}});
    for (int i = 0; i < 2000; ++i) bytes.insert(bytes.end(), {0x55, 0x7E});
    board.write(bytes);
    FrameReader reader;
    bool answered = false;
    while (!board.to_board.bytes.empty() && !answered) {
      board.clock();
      while (!board.to_host.bytes.empty()) {
        const auto frame = reader.take(board.to_host.bytes.front());
        board.to_host.bytes.pop_front();
        answered = answered || (frame && frame->kind == FrameKind::data);
      }
    }
    REQUIRE(answered);
  });
}

TEST_CASE("Latency and throughput are the contract's", "[uart_link]") {
  each_seed(3, [](Dice& dice) {
    Bench<Vuart_link4> top(dice);
    top->tx_ready_i = top->m_axis_tready_i = top->m_axil_awready_i = top->m_axil_wready_i = 1;
    top->m_axil_bvalid_i = 1;  // the response is there as soon as it is waited for
    top->m_axil_bresp_i = 0;
    top->m_axil_arready_i = top->m_axil_rvalid_i = top->rx_valid_i = 0;
    const auto send = [&](const Frame& frame) {
      for (const std::uint8_t byte : encoded(frame)) {
        top->rx_valid_i = 1;
        top->rx_data_i = byte;
        top.settle();
        top.edge();
      }
      top->rx_valid_i = 0;
    };
    // The clocks in which a port was valid, counted from the one after the last flag's.
    const auto when = [&](auto valid) {
      std::vector<int> clocks;
      for (int clock = 1; clock < 120; ++clock) {
        top.settle();
        if (valid()) clocks.push_back(clock);
        top.edge();
      }
      return clocks;
    };
    for (int i = 0; i < 100; ++i) top.edge();  // the ACK of the reset
    send({FrameKind::hello, 0, {}});
    const std::vector<int> ack = when([&] { return top->tx_valid_o != 0; });
    REQUIRE(ack.at(0) == 5);
    REQUIRE(ack.at(1) == 7);
    send(stream_frame(1, {1, 2, 3}));
    REQUIRE(when([&] { return top->m_axis_tvalid_o != 0; }) == std::vector<int>{14, 23, 32});
    Frame frame = stream_frame(2, {0, 1, 2, 3});
    frame.kind = FrameKind::write;
    send(frame);
    REQUIRE(when([&] { return top->m_axil_wvalid_o != 0; }) == std::vector<int>{22, 32, 42});
  });
}

TEST_CASE("The counters are modulo 65536", "[uart_link]") {
  each_seed(1, [](Dice& dice) {
    Board<> board(dice);
    board.pace = 1;
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 65534; ++i) bytes.insert(bytes.end(), {0x55, 0x7E});
    (void)board.exchange(bytes);
    REQUIRE(board.top->bad_frames_o == 65534);
    for (int i = 0; i < 3; ++i) (void)board.exchange({0x55, 0x7E});
    REQUIRE(board.top->bad_frames_o == 1);
    bytes.clear();
    const auto poll = encoded({FrameKind::poll, 0, {}});
    for (int i = 0; i < 65540; ++i) bytes.insert(bytes.end(), poll.begin(), poll.end());
    (void)board.exchange(bytes);
    REQUIRE(board.top->good_frames_o == 4);
  });
}
