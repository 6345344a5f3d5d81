// SPDX-License-Identifier: Apache-2.0
// front_end against the golden front end, token by token: frames of both levels, sound and damaged, with stalls on both
// sides. The module behind it drops some of them, at a fault or at any other token.
#include "polygon/front_end.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "Vfront_end.h"
#include "Vfront_end_glass.h"
#include "Vfront_end_grey.h"
#include "Vfront_end_lights.h"
#include "Vfront_end_linear.h"
#include "bench.hpp"
#include "kage/stream.hpp"
#include "stimulus/damage.hpp"
#include "stimulus/polygon_frames.hpp"

using namespace kage::rtl;

namespace {

using kage::Config;
using kage::ErrorCode;
using kage::Kind;
using kage::Level;
using Words = std::vector<std::uint32_t>;

/// A token as token_reader or front_end gives it.
struct Passed {
  Words words;
  bool header = false;
  bool lacking = false;
  bool cut = false;
  bool ends = false;
  bool at_last = false;
  ErrorCode fault = ErrorCode::NONE;
  std::uint32_t index = 0;

  /// Nothing of the frame may follow it.
  [[nodiscard]] bool bad() const { return lacking || cut || fault != ErrorCode::NONE; }
};

/// The tokens of a frame as token_reader cuts them.
std::vector<Passed> read(const Config& c, const Words& frame) {
  const kage::Layout layout(c);
  const Level level = kage::FrameHeader::read(frame).level();
  std::vector<Passed> out;
  const std::span<const std::uint32_t> all(frame);
  const auto take = [&](std::size_t at, std::size_t count) {
    const auto words = all.subspan(at, std::min(count, all.size() - at));
    out.push_back({Words(words.begin(), words.end())});
    out.back().index = static_cast<std::uint32_t>(out.size() - 1);
    out.back().cut = words.size() < count;
    out.back().at_last = at + count >= all.size();
  };
  take(0, kage::kHeaderWords);
  out.back().header = true;
  for (std::size_t at = kage::kHeaderWords; !out.back().cut;) {
    const std::size_t words = at < all.size() ? layout.words_of(all[at], level) : 1;
    take(at, std::max<std::size_t>(words, 1));
    out.back().lacking = words == 0 && !out.back().cut;
    if (!out.back().cut && kage::kind_of(all[at]) == Kind::END) out.back().ends = true;
    if (out.back().ends) break;
    at += std::max<std::size_t>(words, 1);
  }
  out.back().ends = true;
  return out;
}

/// The tokens that must come out for `in`, up to the first that is bad.
std::vector<Passed> expected(const Config& c, const std::vector<Passed>& in) {
  const kage::Layout layout(c);
  const Level level = kage::FrameHeader::read(in[0].words).level();
  kage::FrontEnd front_end(c);
  front_end.start(kage::FrameHeader::read(in[0].words).width % (1 << c.x_bits));
  std::vector<Passed> out;
  for (const Passed& t : in) {
    if (t.header || t.bad() || level == Level::spans) {
      out.push_back(t);
    } else {
      const kage::Token token = decode(c, layout, t.words, level);
      const ErrorCode e = front_end.accept(token, [&](const kage::Token& made, bool is_made) {
        out.push_back(is_made ? Passed{} : t);
        out.back().index = t.index;
        if (!is_made && made.kind == token.kind) return ErrorCode::NONE;  // as it came, the bits past its fields too
        out.back().words.clear();
        kage::TokenWriter(c, out.back().words).token(made);
        return ErrorCode::NONE;
      });
      if (e != ErrorCode::NONE) {
        out.push_back(t);
        out.back().fault = e;
      }
    }
    if (out.back().bad()) break;
  }
  return out;
}

Words some_frame(const Config& c, Dice& dice) {
  kage::verif::Random random(dice.bits());
  Words words;
  const int width = dice.between(1, std::min(c.max_width, 60));
  const int height = dice.between(1, 24);
  kage::verif::PolygonStyle style;
  style.spans.port = dice.percent(50);
  style.most_polygons = dice.between(0, 5);
  style.most_tokens = dice.between(0, 4);
  style.most_lines = dice.between(1, 12);
  if (dice.percent(15))
    kage::verif::random_frame(random, c, width, height, words);
  else
    kage::verif::random_polygon_frame(random, c, width, height, words, 0, style);
  if (dice.percent(40)) kage::verif::damage_polygons(random, c, words);
  if (dice.percent(10)) kage::verif::damage(random, words);
  // The bench has whole headers: a header that is cut is token_reader's and frame_control's.
  if (words.size() < kage::kHeaderWords) words.resize(kage::kHeaderWords);
  return words;
}

template <class Model>
void front_end_test() {
  constexpr Config c = config_of<Model>();
  const kage::Layout layout(c);
  constexpr FlagsBus kFlags(c);
  each_seed(12, [&](Dice& dice) {
    Bench<Model> top(dice);
    Offer offer(stall_percent(dice));
    const int out_stall = stall_percent(dice);
    const int refused = dice.below(3);  // of a hundred tokens
    std::vector<std::vector<Passed>> in, out;
    for (int i = 0; i < 16; ++i) {
      in.push_back(read(c, some_frame(c, dice)));
      out.push_back(expected(c, in.back()));
    }
    std::size_t in_frame = 0, in_at = 0, out_frame = 0, out_at = 0;
    bool dropping = false;  // the next token is to be dropped
    bool waits = false;
    bool still = false;  // nothing moved in the clock before
    bool was_valid = false;
    bool was_dropped = false;  // drop_i was high in the clock before
    bool owed = false;         // the rest of a frame that is dropped has yet to be offered
    for (int clock = 0; out_frame < out.size() || in_frame < in.size(); ++clock) {
      REQUIRE(clock < 400000);
      const bool offered = offer(dice, in_frame < in.size());
      top->token_valid_i = offered ? 1 : 0;
      const Passed* given = offered ? &in[in_frame][in_at] : nullptr;
      if (given != nullptr) {
        for (std::size_t i = 0; i < given->words.size(); ++i)
          put(top->token_i, static_cast<int>(32 * i), 32, given->words[i]);
        put(top->token_flags_i, kFlags.header, given->header);
        put(top->token_flags_i, kFlags.lacking, given->lacking);
        put(top->token_flags_i, kFlags.cut, given->cut);
        put(top->token_flags_i, kFlags.ends, given->ends);
        put(top->token_flags_i, kFlags.at_last, given->at_last);
        put(top->token_flags_i, kFlags.fault, 0);
      }
      top->dropping_i = dice.percent(10) ? 1 : 0;
      top->token_ready_i = dice.percent(out_stall) ? 0 : 1;
      top->drop_i = 0;
      top.settle();
      if (waits) REQUIRE(top->token_valid_o);
      const bool taken = top->token_valid_o && top->token_ready_i;
      waits = top->token_valid_o && !top->token_ready_i;
      const auto flag = [&](const Place& place) { return get(top->token_flags_o, place) != 0; };
      const bool ends = flag(kFlags.ends);
      if (taken && dropping && !ends) {
        top->drop_i = 1;
        top.settle();
      }
      bool frame_ends = taken && (ends || dropping);
      if (top->token_valid_o && !dropping) {
        REQUIRE(out_frame < out.size());
        REQUIRE(out_at < out[out_frame].size());
        const Passed& e = out[out_frame][out_at];
        INFO("frame " << out_frame << ", token " << e.index);
        REQUIRE(flag(kFlags.header) == e.header);
        REQUIRE(flag(kFlags.lacking) == e.lacking);
        REQUIRE(flag(kFlags.cut) == e.cut);
        REQUIRE(flag(kFlags.ends) == e.ends);
        REQUIRE(get(top->token_flags_o, kFlags.fault) == static_cast<std::uint64_t>(e.fault));
        REQUIRE(top->token_index_o == e.index);
        for (std::size_t i = 0; i < e.words.size() && !e.bad(); ++i)
          REQUIRE(get(top->token_o, static_cast<int>(32 * i), 32) == e.words[i]);
        if (taken) {
          dropping = !ends && (e.bad() || dice.percent(refused));
          ++out_at;
        }
      }
      const bool in_taken = offered && top->token_ready_o;
      // moving_o: where it is low, and nothing comes or leaves, nothing is otherwise a clock later.
      if (still && !in_taken) {
        REQUIRE(!top->moving_o);
        REQUIRE(static_cast<bool>(top->token_valid_o) == was_valid);
      }
      still = !top->moving_o && !taken && !in_taken;
      was_valid = top->token_valid_o;
      if (top->token_valid_o || top->moving_o) REQUIRE((top->busy_o || in_taken));
      // dropping_o: from the clock behind drop_i until the frame's rest has come.
      if (top->dropping_i || was_dropped || owed || top->drop_o) REQUIRE(top->dropping_o);
      if (!offered && still && !was_dropped && !owed && !top->moving_o) REQUIRE(top->dropping_o == top->dropping_i);
      if (offered) owed = false;
      if (top->drop_i && in_frame == out_frame && !(in_taken && given->ends)) owed = true;
      was_dropped = top->drop_i;
      const bool in_dropped = top->drop_o;
      if (in_dropped) REQUIRE((in_taken && !given->ends));
      top.edge();
      if (in_taken) {
        offer.taken();
        if (in_dropped || ++in_at == in[in_frame].size()) {
          in_at = 0;
          ++in_frame;
        }
      }
      if (frame_ends) {
        dropping = false;
        out_at = 0;
        ++out_frame;
      }
    }
    // Nothing is left of the last frame.
    top->token_valid_i = top->dropping_i = top->drop_i = 0;
    for (int n = 0; n < 64; ++n) {
      top.settle();
      REQUIRE(!top->token_valid_o);
      top.edge();
    }
    top.settle();
    REQUIRE(!top->busy_o);
    REQUIRE(!top->moving_o);
    REQUIRE(!top->dropping_o);
  });
}

// ---- clocks ----

// Frames of a few polygons, with no stall on either side.

constexpr Config kTimed = config_of<Vfront_end>();
constexpr int kLines = 40;

/// A frame of kLines lines, with so many polygons that cross all of its lines from line `first` on, and on line `again`
/// so many of them get an edge once more.
Words timed_frame(int polygons, int first, int again = -1, int later_edges = 0) {
  Words words;
  kage::TokenWriter writer(kTimed, words);
  kage::FrameHeader header;
  header.width = 50;
  header.height = kLines;
  header.version = kage::kPolygonVersion;
  writer.header(header);
  for (int y = 0; y < kLines; ++y) {
    for (int i = 0; y == first && i < polygons; ++i) {
      kage::PolygonToken t;
      t.rank = i;
      writer.at(t, 0);
      writer.polygon({}, {});
      for (t.side = 0; t.side < 2; ++t.side) {
        t.last = true;
        t.top_x = t.bottom_x = 256 * (3 + 9 * t.side);
        t.top_y = 256 * first;
        t.bottom_y = 256 * kLines;
        writer.edge(t);
      }
    }
    for (int i = 0; y == again && i < later_edges; ++i) {
      kage::PolygonToken t;
      t.rank = i;
      writer.at(t, 0);
      t.side = 1;
      t.last = true;
      t.top_x = t.bottom_x = 256 * 12;
      t.top_y = 256 * again;
      t.bottom_y = 256 * kLines;
      writer.edge(t);
    }
    writer.eol(y);
  }
  writer.end();
  return words;
}

/// A token, and the clock in which it was taken, or is first there.
struct Timed {
  Kind kind = Kind::END;
  bool header = false;
  int clock = 0;
};
struct Run {
  std::vector<Timed> in, out;
};

Run run(const Words& frame) {
  constexpr FlagsBus kFlags(kTimed);
  const std::vector<Passed> in = read(kTimed, frame);
  Dice dice(1);
  Bench<Vfront_end> top(dice);
  Run r;
  for (int clock = 0; r.out.empty() || r.out.back().kind != Kind::END || r.out.back().header; ++clock) {
    REQUIRE(clock < 10000);
    const std::size_t at = r.in.size();
    top->token_valid_i = at < in.size() ? 1 : 0;
    top->drop_i = top->dropping_i = 0;
    top->token_ready_i = 1;
    if (at < in.size()) {
      put(top->token_flags_i, 0);
      put(top->token_flags_i, kFlags.header, in[at].header);
      put(top->token_flags_i, kFlags.ends, in[at].ends);
      for (std::size_t i = 0; i < in[at].words.size(); ++i)
        put(top->token_i, static_cast<int>(32 * i), 32, in[at].words[i]);
    }
    top.settle();
    if (top->token_valid_i && top->token_ready_o)
      r.in.push_back({kage::kind_of(in[at].words[0], Level::polygons), in[at].header, clock});
    if (top->token_valid_o) {
      const auto word = static_cast<std::uint32_t>(get(top->token_o, 0, 32));
      r.out.push_back({kage::kind_of(word), get(top->token_flags_o, kFlags.header) != 0, clock});
    }
    top.edge();
  }
  return r;
}

/// The first token of a kind.
int clock_of(const std::vector<Timed>& tokens, Kind kind) {
  const auto it = std::ranges::find_if(tokens, [&](const Timed& t) { return t.kind == kind && !t.header; });
  REQUIRE(it != tokens.end());
  return it->clock;
}

}  // namespace

TEST_CASE("front_end makes the golden front end's tokens", "[front_end]") { front_end_test<Vfront_end>(); }

TEST_CASE("front_end makes the golden front end's tokens with smooth colour and translucency", "[front_end]") {
  front_end_test<Vfront_end_glass>();
}

TEST_CASE("front_end makes the golden front end's tokens with lights, counts and units", "[front_end]") {
  front_end_test<Vfront_end_lights>();
}

TEST_CASE("front_end makes the golden front end's tokens with linear light", "[front_end]") {
  front_end_test<Vfront_end_linear>();
}

TEST_CASE("front_end makes the golden front end's tokens without shadows", "[front_end]") {
  front_end_test<Vfront_end_grey>();
}

TEST_CASE("front_end's latencies are those of its contract", "[front_end]") {
  const Run r = run(timed_frame(1, 3));
  REQUIRE(r.in[0].header);
  REQUIRE(r.out[0].header);
  CHECK(r.out[0].clock - r.in[0].clock == 12);
  const auto edges = std::ranges::find_if(r.in, [](const Timed& t) { return t.kind == Kind::EDGE; });
  REQUIRE(std::next(edges)->kind == Kind::EDGE);
  CHECK(clock_of(r.out, Kind::OP) - std::next(edges)->clock == 28);
}

TEST_CASE("a polygon costs front_end a clock a line", "[front_end]") {
  const auto clocks = [](int polygons) { return run(timed_frame(polygons, 0)).out.back().clock; };
  // One clock more a line for each polygon more; those of the line on which it begins are its tokens'.
  CHECK(clocks(6) - clocks(5) == kLines - 1 + 4);
}

TEST_CASE("a later edge costs front_end two clocks", "[front_end]") {
  const auto clocks = [](int edges) { return run(timed_frame(6, 0, kLines / 2, edges)).out.back().clock; };
  // The line's first AT comes while its first polygon is waited for.
  CHECK(clocks(1) - clocks(0) == 1);
  for (int edges = 2; edges <= 6; ++edges) CHECK(clocks(edges) - clocks(edges - 1) == 2);
}

TEST_CASE("a line costs front_end four clocks and its polygons, six at least, or three", "[front_end]") {
  for (const int polygons : {0, 1, 2, 3, 6}) {
    std::vector<int> ends;
    for (const Timed& t : run(timed_frame(polygons, 0)).out)
      if (t.kind == Kind::EOL && !t.header) ends.push_back(t.clock);
    REQUIRE(ends.size() == kLines);
    // From where the queue of tokens no longer waits for the first edges.
    for (std::size_t line = kLines / 2; line < ends.size(); ++line)
      CHECK(ends[line] - ends[line - 1] == (polygons > 0 ? std::max(6, 4 + polygons) : 3));
  }
}
