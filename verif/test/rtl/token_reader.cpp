// SPDX-License-Identifier: Apache-2.0
// token_reader against a reader of words: frames sound, cut, too long, and dropped by the frame's control, for all
// widths of beats.
#include <algorithm>
#include <array>

#include "Vtoken_reader1.h"
#include "Vtoken_reader2.h"
#include "Vtoken_reader4.h"
#include "Vtoken_reader8.h"
#include "bench.hpp"
#include "kage/stream.hpp"

using namespace kage::rtl;

namespace {

using kage::Kind;
// Words of each kind in the default configuration; 0: it lacks the kind.
constexpr auto kWords = kage::Layout(kage::Config{}).words;
constexpr int kTokenWords = 5;  // of the module's port: the header's
static_assert(kTokenWords == kage::kHeaderWords);
constexpr FlagsBus kFlags(kage::Config{});
using Words = std::vector<std::uint32_t>;

struct Expected {
  std::size_t at;  // of its first word
  int words;       // there are
  bool header, lacking, cut, final, at_last;
};

Words random_frame(Dice& dice, int beat) {
  static constexpr Kind kKinds[] = {Kind::SHADE, Kind::OP, Kind::OP, Kind::OP,      Kind::SP, Kind::SP,
                                    Kind::NC,    Kind::IF, Kind::EV, Kind::RESOLVE, Kind::EOL};
  Words w;
  const auto noise = [&](int n) {
    while (n-- > 0) w.push_back(static_cast<std::uint32_t>(dice.bits(32)));
  };
  noise(kTokenWords);
  for (int n = dice.below(20); n > 0; --n) {
    const int kind = dice.percent(3) ? dice.below(16) : static_cast<int>(kKinds[dice.below(11)]);
    w.push_back(static_cast<std::uint32_t>(dice.bits(28) << 4) | static_cast<std::uint32_t>(kind));
    noise(std::max(static_cast<int>(kWords[static_cast<std::size_t>(kind)]) - 1, 0));
  }
  w.push_back(static_cast<std::uint32_t>(Kind::END));
  if (dice.percent(15)) noise(dice.between(1, 20));
  if (dice.percent(20)) w.resize(static_cast<std::size_t>(dice.between(1, static_cast<int>(w.size()))));
  while (w.size() % static_cast<std::size_t>(beat) != 0) noise(1);
  return w;
}

std::vector<Expected> tokens_of(const Words& w, int beat) {
  std::vector<Expected> out;
  for (std::size_t at = 0;;) {
    const int left = static_cast<int>(w.size() - at);
    const bool header = at == 0;
    const int kind = left > 0 ? static_cast<int>(kage::kind_of(w[at])) : 0;
    const int known = header ? kTokenWords : static_cast<int>(kWords[static_cast<std::size_t>(kind)]);
    const int need = std::max(known, 1);
    const bool cut = left < need;
    const bool end = !cut && !header && kind == static_cast<int>(Kind::END);
    const bool at_last = at / static_cast<std::size_t>(beat) == w.size() / static_cast<std::size_t>(beat) - 1;
    out.push_back({at, std::min(left, need), header, !cut && !header && known == 0, cut, cut || end, at_last});
    if (cut || end) return out;
    at += static_cast<std::size_t>(need);
  }
}

/// The token that is offered is this one, of this frame.
template <class Top>
void hold_token(const Top& top, const Expected& e, const Words& frame) {
  const auto flag = [&](const Place& place) { return get(top.token_flags_o, place) != 0; };
  REQUIRE(flag(kFlags.header) == e.header);
  REQUIRE(flag(kFlags.lacking) == e.lacking);
  REQUIRE(flag(kFlags.cut) == e.cut);
  REQUIRE(flag(kFlags.ends) == e.final);
  if (e.final && !e.cut) REQUIRE(flag(kFlags.at_last) == e.at_last);
  for (int i = 0; i < e.words && !e.cut; ++i)
    REQUIRE(get(top.token_o, 32 * i, 32) == frame[e.at + static_cast<std::size_t>(i)]);
}

template <class Model>
void reader_test() {
  constexpr int beat = parameter<Model>("BEAT_WORDS");
  each_seed(20, [&](Dice& dice) {
    Bench<Model> top(dice);
    Offer offer(stall_percent(dice));
    const int out_stall = stall_percent(dice);
    const int frames = 12;
    std::vector<Words> all;
    all.reserve(frames);
    for (int i = 0; i < frames; ++i) all.push_back(random_frame(dice, beat));
    std::size_t in_frame = 0, in_at = 0, out_frame = 0, out_token = 0;
    std::vector<Expected> expected = tokens_of(all[0], beat);
    bool waiting = false;
    for (int clock = 0; out_frame < all.size(); ++clock) {
      REQUIRE(clock < 100000);
      const bool offered = offer(dice, in_frame < all.size());
      top->s_axis_tvalid_i = offered ? 1 : 0;
      if (offered) {
        for (int i = 0; i < beat; ++i)
          put(top->s_axis_tdata_i, 32 * i, 32, all[in_frame][in_at + static_cast<std::size_t>(i)]);
        top->s_axis_tlast_i = in_at + static_cast<std::size_t>(beat) == all[in_frame].size() ? 1 : 0;
      }
      top->token_ready_i = dice.percent(out_stall) ? 0 : 1;
      top->drop_i = 0;
      top.settle();
      const bool taken = top->token_valid_o && top->token_ready_i;
      if (waiting) REQUIRE(top->token_valid_o);
      waiting = top->token_valid_o && !top->token_ready_i;
      if (top->token_valid_o) {
        const Expected& e = expected[out_token];
        hold_token(*top, e, all[out_frame]);
        if (taken && !e.final && (e.lacking || dice.percent(2))) {
          top->drop_i = 1;
          top.settle();
        }
      }
      const bool dropped = top->drop_i;
      const bool beat_taken = offered && top->s_axis_tready_o;
      top.edge();
      if (beat_taken) {
        offer.taken();
        in_at += static_cast<std::size_t>(beat);
        if (in_at == all[in_frame].size()) {
          in_at = 0;
          ++in_frame;
        }
      }
      if (taken && (dropped || expected[out_token].final)) {
        out_token = 0;
        if (++out_frame < all.size()) expected = tokens_of(all[out_frame], beat);
      } else if (taken) {
        ++out_token;
      }
    }
  });
}

/// Without stalls a token takes as many clocks as its words need on the port, at least one.
template <class Model>
void speed_test() {
  constexpr int beat = parameter<Model>("BEAT_WORDS");
  each_seed(5, [&](Dice& dice) {
    for (const int kind : {6, 8}) {
      Bench<Model> top(dice);
      const int words = kWords[static_cast<std::size_t>(kind)];
      const int tokens = 64;
      top->token_ready_i = 1;
      top->drop_i = 0;
      top->s_axis_tvalid_i = 1;
      top->s_axis_tlast_i = 0;
      int given = 0, got = -1, first = 0, clock = 0;  // the header is not counted
      for (; got < tokens; ++clock) {
        for (int i = 0; i < beat; ++i) {
          const int at = given + i - kTokenWords;
          put(top->s_axis_tdata_i, 32 * i, 32, at >= 0 && at % words == 0 ? static_cast<std::uint64_t>(kind) : 0x600DU);
        }
        top.settle();
        if (top->token_valid_o) {
          if (got == 0) first = clock;
          ++got;
        }
        if (top->s_axis_tready_o) given += beat;
        top.edge();
      }
      const int per_token = std::max(beat, words) / beat;
      CAPTURE(beat, kind, clock, first);
      REQUIRE(clock - 1 - first <= (tokens - 1) * per_token + (words % beat == 0 ? 0 : 1));
    }
  });
}

}  // namespace

TEST_CASE("token_reader, beats of 1 word", "[token_reader]") { reader_test<Vtoken_reader1>(); }
TEST_CASE("token_reader, beats of 2 words", "[token_reader]") { reader_test<Vtoken_reader2>(); }
TEST_CASE("token_reader, beats of 4 words", "[token_reader]") { reader_test<Vtoken_reader4>(); }
TEST_CASE("token_reader, beats of 8 words", "[token_reader]") { reader_test<Vtoken_reader8>(); }
TEST_CASE("token_reader keeps up with its port", "[token_reader]") {
  speed_test<Vtoken_reader1>();
  speed_test<Vtoken_reader2>();
  speed_test<Vtoken_reader4>();
  speed_test<Vtoken_reader8>();
}
