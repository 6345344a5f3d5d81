// SPDX-License-Identifier: Apache-2.0
// Whatever a board says, a link's functions end: with their result or with an error of one line. The board is a script:
// it answers every frame, and goes on answering, with fields that a case chooses.
#include "board/link.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <string>

#include "stimulus/random.hpp"
#include "test/support/catch.hpp"

using namespace kage;
using namespace kage::board;

namespace {

struct Ack {
  std::uint8_t expected = 0, limit = 0, done = 0, session = 0, flags = 0;
};

/// Takes every frame in order and executes it at once, but that `say` changes each answer first. `babbles`: it answers
/// whenever it is listened to, too.
class Script : public Transport {
 public:
  std::function<void(Ack&, std::uint64_t number)> say;
  bool answers_read = true;
  bool babbles = false;

  void write(std::span<const std::uint8_t> bytes) override {
    for (const std::uint8_t byte : bytes) {
      time_ += 3;
      if (const auto frame = reader_.take(byte)) take(*frame);
    }
  }
  std::size_t read(std::span<std::uint8_t> bytes, std::uint64_t deadline) override {
    // A second of a serial line of 3,000,000 baud has fewer calls than this; the link's patience here is a tenth.
    if (++reads_ > 1'000'000) throw std::runtime_error("the link does not end");
    if (babbles && out_.empty()) answer();
    std::size_t n = 0;
    for (; n < bytes.size() && !out_.empty(); ++n) {
      bytes[n] = out_.front();
      out_.pop_front();
    }
    time_ = n == 0 ? std::max(time_, deadline) : time_ + 3 * n;
    return n;
  }
  std::uint64_t now() override { return time_; }

 private:
  void take(const Frame& frame) {
    if (frame.kind == FrameKind::hello) {
      ack_ = {static_cast<std::uint8_t>(frame.sequence + 1), 0, static_cast<std::uint8_t>(frame.sequence + 1),
              frame.sequence, 0};
    } else if (frame.kind != FrameKind::poll && frame.sequence == ack_.expected) {
      ++ack_.expected;
      ++ack_.done;
      if (frame.kind == FrameKind::read && answers_read) {
        std::vector<std::uint8_t> payload(4 * std::size_t{frame.payload[4]} + 1);
        put({FrameKind::data, frame.sequence, std::move(payload)});
      }
    }
    answer();
  }
  void answer() {
    Ack a = ack_;
    a.limit = static_cast<std::uint8_t>(a.expected + 4);
    if (say) say(a, number_++);
    put({FrameKind::ack, a.expected, {a.limit, a.done, a.session, a.flags}});
  }
  void put(const Frame& frame) {
    for (const std::uint8_t byte : encoded(frame)) out_.push_back(byte);
  }

  FrameReader reader_;
  Ack ack_;
  std::deque<std::uint8_t> out_;
  std::uint64_t time_ = 0, number_ = 0, reads_ = 0;
};

/// A session with the board; what ends it. Empty if all was done.
std::string session(Script& board, std::uint64_t patience) {
  Link link(board, {.timeout = 10'000, .tries = 5, .patience = patience});
  try {
    link.hello();
    const std::array<std::uint32_t, 600> words{};
    link.write(0, words);
    link.flush();
    (void)link.read(0, 3);
    link.stream(words);
    link.flush();
  } catch (const LinkError& e) {
    return e.what();
  }
  return "";
}

struct Case {
  const char* name;
  std::function<void(Ack&, std::uint64_t)> say;
};

}  // namespace

TEST_CASE("a board that says what is so is taken at its word") {
  Script board;
  CHECK(session(board, 100'000).empty());
  Script one_slot;
  one_slot.say = [](Ack& a, std::uint64_t) { a.limit = static_cast<std::uint8_t>(a.expected + 1); };
  CHECK(session(one_slot, 100'000).empty());
}

TEST_CASE("a session with a board whose answers cannot be ends with one line") {
  const auto add = [](std::uint8_t& field, std::uint64_t n) { field = static_cast<std::uint8_t>(field + n); };
  const Case cases[] = {
      {"done alternates", [&](Ack& a, std::uint64_t n) { add(a.done, n % 2 == 0 ? 255 : 254); }},
      {"done alternates with far", [&](Ack& a, std::uint64_t n) { add(a.done, n % 2 == 0 ? 255 : 100); }},
      {"done is ahead and alternates", [&](Ack& a, std::uint64_t n) { add(a.done, 1 + n % 2); }},
      {"done counts up for ever", [&](Ack& a, std::uint64_t n) { a.done = static_cast<std::uint8_t>(n); }},
      {"done counts down for ever", [&](Ack& a, std::uint64_t n) { a.done = static_cast<std::uint8_t>(~n); }},
      {"done is one too few", [&](Ack& a, std::uint64_t) { add(a.done, 255); }},
      {"expected alternates",
       [&](Ack& a, std::uint64_t n) {
         add(a.expected, n % 2 == 0 ? 0 : 255);
         add(a.done, 255);
       }},
      {"expected and done count up",
       [&](Ack& a, std::uint64_t n) { a.expected = a.done = static_cast<std::uint8_t>(n); }},
      {"no room, then room",
       [&](Ack& a, std::uint64_t n) {
         a.limit = n % 2 == 0 ? a.expected : a.limit;
         add(a.done, 255);
       }},
      {"always a gap",
       [&](Ack& a, std::uint64_t) {
         a.flags |= kDropped;
         add(a.done, 255);
       }},
  };
  for (const Case& c : cases)
    for (const bool babbles : {false, true})
      for (const std::uint64_t patience : {std::uint64_t{100'000}, std::uint64_t{0}}) {
        // To wait for ever is what patience 0 asks for, of a board whose answers can be.
        if (patience == 0 && std::string(c.name) == "done is one too few") continue;
        if (patience == 0 && std::string(c.name) == "always a gap") continue;
        if (patience == 0 && std::string(c.name) == "no room, then room") continue;
        CAPTURE(c.name, babbles, patience);
        Script board;
        board.say = c.say;
        board.babbles = babbles;
        const std::string said = session(board, patience);
        // A count that only goes up passes all places at some time: what it says may be taken for so.
        if (std::string(c.name).find("count") == std::string::npos)
          CHECK_THAT(said, Catch::Matchers::ContainsSubstring("link: "));
        CHECK(said.find('\n') == std::string::npos);
      }
}

TEST_CASE("a session with a board of random answers ends") {
  verif::Random random(47);
  for (int i = 0; i < 300; ++i) {
    Script board;
    const auto field = [&](std::uint8_t& f) {
      if (random.chance(0.25)) f = static_cast<std::uint8_t>(f + random.in(0, random.chance(0.5) ? 3 : 255));
    };
    board.say = [&](Ack& a, std::uint64_t) {
      field(a.expected);
      field(a.limit);
      field(a.done);
    };
    board.answers_read = random.chance(0.5);
    board.babbles = random.chance(0.5);
    CAPTURE(i);
    CHECK(session(board, 100'000).find('\n') == std::string::npos);
  }
}
