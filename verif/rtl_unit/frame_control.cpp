// SPDX-License-Identifier: Apache-2.0
// frame_control: the commands and lines that a frame becomes, and each error with its code, line and token. Default
// configuration (X_BITS 11, Z 24.11, three flat channels, DSF_BITS 1, FSF), MAX_WIDTH 64.
#include <array>
#include <deque>

#include "Vframe_control.h"
#include "Vframe_control_glass.h"
#include "Vframe_control_lights.h"
#include "bench.hpp"
#include "kage/defs.hpp"
#include "kage/stream.hpp"

using namespace kage::rtl;
using kage::ErrorCode;
using kage::Kind;

namespace {

constexpr kage::Config kConfig{};
constexpr kage::Config kGlass = [] {
  kage::Config c;
  c.translucency = 1;
  return c;
}();
constexpr kage::Config kLights = [] {
  kage::Config c = kGlass;
  c.count_bits = 4;
  c.lights = 3;
  c.class_bits = 5;
  return c;
}();
constexpr Kind kOut = Kind::TABLE;  // a command without token: the line's pixels leave and come back (kage_widths.svh)
constexpr int kMaxWidth = 64;

struct Token {
  std::array<std::uint32_t, 5> words{};
  bool header = false, lacking = false, cut = false, final = false, at_last = false;
};

void set(Token& t, int lsb, int bits, std::uint64_t value) {
  for (int i = 0; i < bits; ++i)
    if ((value >> i & 1) != 0) t.words[static_cast<std::size_t>((lsb + i) / 32)] |= 1U << ((lsb + i) % 32);
}

Token header(std::uint32_t width, std::uint32_t height, std::uint32_t frame, const kage::Config& config = kConfig) {
  Token t;
  t.header = true;
  t.words = {kage::kStreamMagic << 16 | kage::kStreamVersion, width | height << 16, kage::param_hash(config), 0x0A0B0C,
             frame};
  return t;
}

Token token(Kind kind, std::uint64_t a = 0, std::uint64_t b = 0, std::uint64_t c = 0) {
  Token t;
  set(t, 0, 4, static_cast<std::uint64_t>(kind));
  switch (kind) {
    case Kind::SHADE:
      set(t, 4, 9, a);
      break;
    case Kind::EOL:
      set(t, 4, 16, a);
      break;
    case Kind::IF:
      set(t, 4, 2, a);
      break;
    case Kind::OP:  // lit, then z, dz, colour
      set(t, 4, 11, a);
      set(t, 15, 11, b);
      set(t, 26, 1, c);
      set(t, 27, 37, 0x123456789);
      set(t, 64, 37, 0x0FEDCBA98);
      set(t, 101, 24, 0x332211);
      break;
    case Kind::SP:  // w, then z, dz
      set(t, 4, 11, a);
      set(t, 15, 11, b);
      set(t, 26, 2, c);
      set(t, 28, 37, 0x11111111);
      set(t, 65, 37, 0x22222222);
      break;
    case Kind::TP:  // alpha, then z, dz, colour
      set(t, 4, 11, a);
      set(t, 15, 11, b);
      set(t, 26, 8, c);
      set(t, 34, 37, 0x0F1234567);
      set(t, 71, 37, 0x0A9876543);
      set(t, 108, 24, 0x665544);
      break;
    case Kind::NC:
      set(t, 26, 2, c);
      [[fallthrough]];
    case Kind::EV:
      set(t, 4, 11, a);
      set(t, 15, 11, b);
      break;
    default:
      break;
  }
  t.final = kind == Kind::END;
  t.at_last = true;
  return t;
}

/// A token of the lights configuration, as `write` writes it.
template <class Write>
Token lights_token(Write write) {
  std::vector<std::uint32_t> words;
  kage::TokenWriter writer(kLights, words);
  write(writer);
  Token t;
  std::copy(words.begin(), words.end(), t.words.begin());
  t.final = (words[0] & 15U) == static_cast<std::uint32_t>(Kind::END);
  t.at_last = true;
  return t;
}

struct Entry {
  unsigned normal_class, light;
  std::uint64_t share;
  bool operator==(const Entry&) const = default;
};

struct Command {
  Kind kind;
  unsigned xl, xr, count;
  bool operator==(const Command&) const = default;
};

struct Line {
  bool first, blank;
  unsigned width, background, shade;
  bool operator==(const Line&) const = default;
};

struct Outcome {
  std::vector<Command> commands;
  std::vector<Line> lines;
  std::vector<bool> painted;  // of each line
  std::vector<bool> loads;    // of each line
  std::vector<Entry> table;
  std::vector<unsigned> shares;                      // of each command
  std::vector<std::array<std::uint32_t, 4>> errors;  // code, frame, line, token
  int frames = 0, drops = 0;
};

template <class Model = Vframe_control>
Outcome run(Dice& dice, const std::vector<Token>& tokens) {
  Bench<Model> top(dice);
  Offer offer(stall_percent(dice));
  const int cmd_stall = stall_percent(dice);
  const int line_stall = stall_percent(dice);
  Outcome out;
  int dropping = 0;
  int loading = 0;  // clocks until the loads of a line have come back
  const int table_stall = stall_percent(dice);
  std::size_t at = 0;
  for (int clock = 0, quiet = 0; quiet < 200; ++clock) {
    REQUIRE(clock < 100000);
    const bool offered = dropping == 0 && offer(dice, at < tokens.size());
    top->token_valid_i = offered ? 1 : 0;
    if (offered) {
      const Token& t = tokens[at];
      for (int i = 0; i < 5; ++i) put(top->token_i, 32 * i, 32, t.words[static_cast<std::size_t>(i)]);
      top->token_header_i = t.header ? 1 : 0;
      top->token_lacking_i = t.lacking ? 1 : 0;
      top->token_cut_i = t.cut ? 1 : 0;
      top->token_final_i = t.final ? 1 : 0;
      top->token_at_last_i = t.at_last ? 1 : 0;
    }
    top->dropping_i = dropping > 0 ? 1 : 0;
    top->cmd_ready_i = dice.percent(cmd_stall) ? 0 : 1;
    top->line_ready_i = dice.percent(line_stall) ? 0 : 1;
    top->table_free_i = dice.percent(table_stall) ? 0 : 1;
    top->loads_done_i = loading == 1 ? 1 : 0;
    top.settle();
    if (loading > 0) {
      REQUIRE_FALSE(top->cmd_valid_o);
      REQUIRE_FALSE(top->line_valid_o);
      REQUIRE_FALSE((top->token_valid_i && top->token_ready_o));
      --loading;
    }
    if (top->table_valid_o) {
      REQUIRE(top->table_free_i);
      out.table.push_back({top->table_class_o, top->table_light_o, get(top->table_share_o, 0, 27)});
    }
    if (top->cmd_valid_o && top->cmd_ready_i) {
      const auto kind = static_cast<Kind>(top->cmd_kind_o);
      if (kind == kOut) loading = dice.between(1, 20);
      // TP has no count.
      out.commands.push_back({kind, top->cmd_xl_o, top->cmd_xr_o, kind == Kind::TP ? 0U : top->cmd_count_o});
      if (kind == Kind::OP && !std::is_same_v<Model, Vframe_control_lights>) {
        REQUIRE(get(top->cmd_z_o, 0, 37) == 0x123456789);
        REQUIRE(get(top->cmd_dz_o, 0, 37) == 0x0FEDCBA98);
        REQUIRE(top->cmd_color_o == 0x332211);
      }
      out.shares.push_back(top->cmd_share_o);
      if (kind == Kind::TP && !std::is_same_v<Model, Vframe_control_lights>) {
        REQUIRE(get(top->cmd_z_o, 0, 37) == 0x0F1234567);
        REQUIRE(get(top->cmd_dz_o, 0, 37) == 0x0A9876543);
        REQUIRE(top->cmd_color_o == 0x665544);
      }
      if (kind == Kind::RESOLVE) REQUIRE(top->cmd_color_o == 0x0A0B0C);
      if (kind == Kind::SP) {
        REQUIRE(get(top->cmd_z_o, 0, 37) == 0x11111111);
        REQUIRE(get(top->cmd_dz_o, 0, 37) == 0x22222222);
      }
    }
    if (top->line_valid_o) {
      REQUIRE(top->line_ready_i);
      out.lines.push_back({static_cast<bool>(top->line_first_o), static_cast<bool>(top->line_blank_o),
                           top->line_width_o, top->line_background_o, top->line_shade_o});
    }
    if (top->line_valid_o) out.painted.push_back(top->line_painted_o != 0);
    if (top->line_valid_o) out.loads.push_back(top->line_load_o != 0);
    if (top->error_o)
      out.errors.push_back({top->error_code_o, top->error_frame_o, top->error_line_o, top->error_token_o});
    if (top->frame_end_o) ++out.frames;
    if (dropping > 0) --dropping;
    const bool taken = offered && top->token_ready_o;
    if (top->drop_o) {
      REQUIRE(taken);
      REQUIRE(!tokens[at].final);
      ++out.drops;
      dropping = dice.between(1, 9);
    }
    quiet = taken || top->cmd_valid_o || top->line_valid_o ? 0 : quiet + 1;
    top.edge();
    if (!taken) continue;
    offer.taken();
    const bool dropped = dropping > 0;
    ++at;
    while (dropped && at < tokens.size() && !tokens[at].header) ++at;
  }
  REQUIRE(at == tokens.size());
  REQUIRE(!top->open_o);
  return out;
}

std::vector<Token> operator+(std::vector<Token> a, const std::vector<Token>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A frame of 2 lines with this as line 0; what the error is, and that the rest is blank.
void expect_error(std::vector<Token> body, ErrorCode code, unsigned line, unsigned index, unsigned height = 2) {
  each_seed(6, [&](Dice& dice) {
    CAPTURE(static_cast<int>(code), line, index);
    const std::vector<Token> next = {header(1, 1, 8), token(Kind::EOL, 0), token(Kind::END)};
    const Outcome out = run(dice, std::vector<Token>{header(20, height, 7)} + body + next);
    REQUIRE(out.errors.size() == 1);
    REQUIRE(out.errors[0] == std::array<std::uint32_t, 4>{static_cast<std::uint32_t>(code), 7, line, index});
    REQUIRE(out.frames == 2);
    REQUIRE(out.lines.size() == height + 1);
    for (unsigned y = 0; y < height; ++y) {
      REQUIRE(out.lines[y].blank == (y >= line));
      REQUIRE(out.lines[y].first == (y == 0));
    }
    REQUIRE(out.lines.back() == Line{true, false, 1, 0x0A0B0C, 0});
    REQUIRE(out.commands.back() == Command{Kind::EOL, 0, 1, 0});
  });
}

const Token kEol0 = token(Kind::EOL, 0);
const Token kEol1 = token(Kind::EOL, 1);
const Token kEnd = token(Kind::END);

}  // namespace

TEST_CASE("A frame becomes commands and lines; bias goes with EV and is cleared by it", "[frame_control]") {
  each_seed(20, [](Dice& dice) {
    const Outcome out =
        run(dice, {header(20, 2, 7), token(Kind::SHADE, 256), token(Kind::OP, 3, 9, 1), token(Kind::OP, 4, 4, 1),
                   token(Kind::SP, 0, 20, 1), token(Kind::IF, 1), token(Kind::EV, 1, 19), token(Kind::NC, 2, 3, 3),
                   token(Kind::EV, 0, 20), token(Kind::RESOLVE), kEol0, token(Kind::OP, 19, 20, 0), kEol1, kEnd});
    REQUIRE(out.errors.empty());
    REQUIRE(out.frames == 1);
    REQUIRE(out.drops == 0);
    REQUIRE(out.commands == std::vector<Command>{{Kind::OP, 3, 9, 1},
                                                 {Kind::SP, 0, 20, 1},
                                                 {Kind::EV, 1, 19, 1},
                                                 {Kind::NC, 2, 3, 1},
                                                 {Kind::EV, 0, 20, 0},
                                                 {Kind::EOL, 0, 20, 0},
                                                 {Kind::OP, 19, 20, 0},
                                                 {Kind::EOL, 0, 20, 0}});
    REQUIRE(out.lines == std::vector<Line>{{true, false, 20, 0x0A0B0C, 256}, {false, false, 20, 0x0A0B0C, 256}});
  });
}

TEST_CASE("A line's first TP is preceded by a RESOLVE over the line, with bias, shade and background",
          "[frame_control]") {
  each_seed(20, [](Dice& dice) {
    const auto out = run<Vframe_control_glass>(
        dice, {header(20, 4, 7, kGlass), token(Kind::SHADE, 200), token(Kind::OP, 3, 9, 1), token(Kind::TP, 1, 2, 77),
               token(Kind::TP, 4, 4, 78), token(Kind::TP, 0, 20, 255), kEol0, token(Kind::SP, 0, 20, 1),
               token(Kind::EV, 0, 20), token(Kind::RESOLVE), kEol1, token(Kind::NC, 5, 6, 1), token(Kind::EV, 0, 20),
               token(Kind::RESOLVE), token(Kind::TP, 19, 20, 0), token(Kind::EOL, 2), token(Kind::TP, 3, 3, 1),
               token(Kind::EOL, 3), kEnd});
    REQUIRE(out.errors.empty());
    REQUIRE(out.commands == std::vector<Command>{{Kind::OP, 3, 9, 1},
                                                 {Kind::RESOLVE, 0, 20, 0},
                                                 {Kind::TP, 1, 2, 0},
                                                 {Kind::TP, 0, 20, 0},
                                                 {Kind::EOL, 0, 20, 0},
                                                 {Kind::SP, 0, 20, 1},
                                                 {Kind::EV, 0, 20, 0},
                                                 {Kind::EOL, 0, 20, 0},
                                                 {Kind::NC, 5, 6, 1},
                                                 {Kind::EV, 0, 20, 0},
                                                 {Kind::RESOLVE, 0, 20, 0},
                                                 {Kind::TP, 19, 20, 0},
                                                 {Kind::EOL, 0, 20, 0},
                                                 {Kind::RESOLVE, 0, 20, 0},
                                                 {Kind::EOL, 0, 20, 0}});
    REQUIRE(out.painted == std::vector<bool>{true, false, true, true});
    REQUIRE(out.shares[1] == 200);
    REQUIRE(out.shares[2] == 77);
    REQUIRE(out.shares[3] == 255);
    REQUIRE(out.shares[10] == 200);
    REQUIRE(out.shares[11] == 0);
  });
}

TEST_CASE("TP comes after RESOLVE, and nothing but TP and EOL after it", "[frame_control]") {
  const auto expect_order = [](std::vector<Token> body, std::uint32_t index, std::uint32_t line = 0) {
    each_seed(4, [&](Dice& dice) {
      CAPTURE(index);
      const auto out = run<Vframe_control_glass>(dice, std::vector<Token>{header(20, 1, 7, kGlass)} + body);
      REQUIRE(out.errors.size() == 1);
      REQUIRE(out.errors[0] ==
              std::array<std::uint32_t, 4>{static_cast<std::uint32_t>(ErrorCode::ORDER), 7, line, index});
      REQUIRE(out.lines.size() == 1);
      REQUIRE(out.lines[0].blank == (line == 0));
    });
  };
  const Token tp = token(Kind::TP, 0, 20, 128);
  expect_order({token(Kind::SP, 0, 1), tp}, 2);
  expect_order({token(Kind::SP, 0, 1), token(Kind::EV, 0, 1), tp}, 3);
  expect_order({tp, token(Kind::OP, 0, 1)}, 2);
  expect_order({tp, token(Kind::SP, 0, 1)}, 2);
  expect_order({tp, token(Kind::NC, 0, 1)}, 2);
  expect_order({tp, token(Kind::IF, 1)}, 2);
  expect_order({tp, token(Kind::EV, 0, 1)}, 2);
  expect_order({tp, token(Kind::RESOLVE)}, 2);
  expect_order({kEol0, tp}, 2, 1);
}

namespace {

Token lights_op(int xl, int xr, int normal_class) {
  kage::SpanToken s;
  s.xl = xl;
  s.xr = xr;
  s.normal_class = normal_class;
  return lights_token([&](kage::TokenWriter& w) { w.op(s); });
}

Token lights_entry(int normal_class, int light, std::uint32_t share) {
  return lights_token([&](kage::TokenWriter& w) { w.table({normal_class, light, {share, share, share}}); });
}

Token sample_end(int xl, int xr, int light) {
  return lights_token([&](kage::TokenWriter& w) { w.es(xl, xr, light); });
}

const Token kLightsTp = lights_token([](kage::TokenWriter& w) {
  kage::SpanToken s;
  s.xl = 3;
  s.xr = 9;
  w.tp(s);
});

}  // namespace

TEST_CASE("ES has its light; after RESOLVE a line's first TP waits until its colours have come back",
          "[frame_control]") {
  each_seed(20, [](Dice& dice) {
    const Token nc = token(Kind::NC, 0, 20, 1), ev = token(Kind::EV, 0, 20), resolve = token(Kind::RESOLVE);
    const auto out = run<Vframe_control_lights>(dice, {header(20, 3, 7, kLights),
                                                       lights_entry(1, 0, 5),
                                                       lights_entry(1, 1, 256),
                                                       lights_entry(1, 2, 7),
                                                       lights_entry(2, 0, 1),
                                                       lights_op(0, 20, 1),
                                                       lights_op(1, 2, 0),
                                                       nc,
                                                       ev,
                                                       sample_end(1, 19, 2),
                                                       nc,
                                                       ev,
                                                       sample_end(5, 5, 0),
                                                       nc,
                                                       ev,
                                                       sample_end(0, 20, 1),
                                                       resolve,
                                                       kLightsTp,
                                                       kLightsTp,
                                                       kEol0,
                                                       lights_op(0, 1, 0),
                                                       kLightsTp,
                                                       kEol1,
                                                       nc,
                                                       ev,
                                                       sample_end(2, 3, 0),
                                                       resolve,
                                                       token(Kind::EOL, 2),
                                                       kEnd});
    REQUIRE(out.errors.empty());
    const auto three = [](std::uint64_t share) { return share | share << 9 | share << 18; };
    REQUIRE(out.table == std::vector<Entry>{{1, 0, three(5)}, {1, 1, three(256)}, {1, 2, three(7)}, {2, 0, three(1)}});
    REQUIRE(out.commands ==
            std::vector<Command>{
                {Kind::OP, 0, 20, 1}, {Kind::OP, 1, 2, 0},   {Kind::NC, 0, 20, 1}, {Kind::EV, 0, 20, 0},
                {Kind::ES, 1, 19, 2}, {Kind::NC, 0, 20, 1},  {Kind::EV, 0, 20, 0}, {Kind::NC, 0, 20, 1},
                {Kind::EV, 0, 20, 0}, {Kind::ES, 0, 20, 1},  {kOut, 0, 20, 0},     {Kind::TP, 3, 9, 0},
                {Kind::TP, 3, 9, 0},  {Kind::EOL, 0, 20, 0}, {Kind::OP, 0, 1, 0},  {Kind::RESOLVE, 0, 20, 0},
                {Kind::TP, 3, 9, 0},  {Kind::EOL, 0, 20, 0}, {Kind::NC, 0, 20, 1}, {Kind::EV, 0, 20, 0},
                {Kind::ES, 2, 3, 0},  {Kind::EOL, 0, 20, 0}});
    REQUIRE(out.loads == std::vector<bool>{true, false, false, false});
    REQUIRE(out.painted == std::vector<bool>{false, true, true, false});
  });
}

TEST_CASE("TABLE in order, whole classes only; ES once a sample, RESOLVE after it", "[frame_control]") {
  const auto expect = [](const std::vector<Token>& body, ErrorCode code, std::uint32_t index) {
    each_seed(4, [&](Dice& dice) {
      CAPTURE(static_cast<int>(code), index);
      const auto out = run<Vframe_control_lights>(dice, std::vector<Token>{header(20, 1, 7, kLights)} + body);
      REQUIRE(out.errors.size() == 1);
      REQUIRE(out.errors[0] == std::array<std::uint32_t, 4>{static_cast<std::uint32_t>(code), 7, 0, index});
      REQUIRE(out.lines.back().blank);
    });
  };
  const std::vector<Token> whole{lights_entry(1, 0, 1), lights_entry(1, 1, 1), lights_entry(1, 2, 1)};
  expect({lights_entry(1, 1, 1)}, ErrorCode::RANGE, 1);
  expect({lights_entry(0, 0, 1)}, ErrorCode::RANGE, 1);
  expect({lights_entry(2, 0, 1)}, ErrorCode::RANGE, 1);
  expect({lights_entry(1, 0, 1), lights_entry(1, 0, 1)}, ErrorCode::RANGE, 2);
  expect({lights_entry(1, 0, 257)}, ErrorCode::RANGE, 1);
  expect(whole + std::vector<Token>{lights_entry(1, 3, 1)}, ErrorCode::RANGE, 4);
  expect(whole + std::vector<Token>{lights_op(0, 1, 2)}, ErrorCode::RANGE, 4);
  expect({lights_entry(1, 0, 1), lights_entry(1, 1, 1), lights_op(0, 1, 1)}, ErrorCode::RANGE, 3);
  expect(whole + std::vector<Token>{lights_op(0, 1, 1), lights_entry(2, 0, 1)}, ErrorCode::ORDER, 5);
  const Token volume = token(Kind::NC, 0, 1, 1), ev = token(Kind::EV, 0, 1), es = sample_end(0, 1, 0);
  expect({es}, ErrorCode::ORDER, 1);
  expect({volume, es}, ErrorCode::ORDER, 2);
  expect({volume, ev, es, es}, ErrorCode::ORDER, 4);
  expect({volume, ev, token(Kind::RESOLVE)}, ErrorCode::ORDER, 3);
  expect({volume, ev, es, token(Kind::EOL, 0)}, ErrorCode::ORDER, 4);
  expect({volume, ev, es, token(Kind::RESOLVE), es}, ErrorCode::ORDER, 5);
  expect({volume, ev, sample_end(0, 1, 3)}, ErrorCode::RANGE, 3);
  expect({volume, ev, sample_end(2, 1, 0)}, ErrorCode::RANGE, 3);
  expect({volume, ev, sample_end(0, 21, 0)}, ErrorCode::RANGE, 3);
}

TEST_CASE("SHADE holds for its frame only", "[frame_control]") {
  each_seed(5, [](Dice& dice) {
    const Outcome out = run(dice, {header(1, 1, 1), token(Kind::SHADE, 9), kEol0, kEnd, header(1, 1, 2), kEol0, kEnd});
    REQUIRE(out.lines.size() == 2);
    REQUIRE(out.lines[0].shade == 9);
    REQUIRE(out.lines[1].shade == 0);
  });
}

TEST_CASE("Errors of kind, order, range and line, each at its place", "[frame_control]") {
  Token lacking = token(static_cast<Kind>(2));
  lacking.lacking = true;
  Token cut = token(Kind::OP, 0, 20);
  cut.cut = cut.final = true;
  Token early_end = kEnd;
  Token late_end = kEnd;
  late_end.at_last = false;
  expect_error({lacking}, ErrorCode::KIND, 0, 1);
  expect_error({kEol0, lacking}, ErrorCode::KIND, 1, 2);
  expect_error({cut}, ErrorCode::LAST_EARLY, 0, 1);
  expect_error({kEol0, kEol1, cut}, ErrorCode::LAST_EARLY, 2, 3);
  expect_error({token(Kind::OP, 0, 1), token(Kind::SHADE, 1)}, ErrorCode::ORDER, 0, 2);
  expect_error({token(Kind::SHADE, 1), token(Kind::SHADE, 1)}, ErrorCode::ORDER, 0, 2);
  expect_error({token(Kind::SP, 0, 1), token(Kind::OP, 0, 1)}, ErrorCode::ORDER, 0, 2);
  expect_error({token(Kind::EV, 0, 1)}, ErrorCode::ORDER, 0, 1);
  expect_error({token(Kind::SP, 0, 1), token(Kind::EV, 0, 1), token(Kind::EV, 0, 1)}, ErrorCode::ORDER, 0, 3);
  expect_error({token(Kind::RESOLVE)}, ErrorCode::ORDER, 0, 1);
  expect_error({token(Kind::NC, 0, 1), token(Kind::RESOLVE)}, ErrorCode::ORDER, 0, 2);
  expect_error({token(Kind::NC, 0, 1), kEol0}, ErrorCode::ORDER, 0, 2);
  expect_error({token(Kind::IF, 1), token(Kind::EV, 0, 1), token(Kind::RESOLVE), token(Kind::IF, 1)}, ErrorCode::ORDER,
               0, 4);
  expect_error({kEol0, kEol1, token(Kind::OP, 0, 1)}, ErrorCode::ORDER, 2, 3);
  expect_error({kEol0, kEol1, token(Kind::EOL, 2)}, ErrorCode::ORDER, 2, 3);
  expect_error({token(Kind::SHADE, 257)}, ErrorCode::RANGE, 0, 1);
  expect_error({token(Kind::OP, 2, 1)}, ErrorCode::RANGE, 0, 1);
  expect_error({token(Kind::OP, 0, 21)}, ErrorCode::RANGE, 0, 1);
  expect_error({token(Kind::NC, 0, 1), token(Kind::EV, 5, 4)}, ErrorCode::RANGE, 0, 2);
  expect_error({kEol1}, ErrorCode::LINE, 0, 1);
  expect_error({token(Kind::EOL, 0x8000)}, ErrorCode::LINE, 0, 1);
  expect_error({early_end}, ErrorCode::LINE, 0, 1);
  expect_error({kEol0, token(Kind::SP, 0, 1), early_end}, ErrorCode::LINE, 1, 3);
  expect_error({kEol0, kEol1, late_end}, ErrorCode::LAST_LATE, 2, 3);
}

TEST_CASE("The earlier check wins: kind, order, range", "[frame_control]") {
  expect_error({token(Kind::SP, 0, 1), token(Kind::OP, 9, 99)}, ErrorCode::ORDER, 0, 2);
  Token cut = token(Kind::EV, 0, 1);
  cut.cut = cut.final = true;
  expect_error({cut}, ErrorCode::LAST_EARLY, 0, 1);  // not whole: its order is not checked
}

TEST_CASE("A bad header gives no pixels and is named", "[frame_control]") {
  struct Case {
    Token header;
    ErrorCode code;
    std::uint32_t frame;
  };
  Token magic = header(1, 1, 5), params = header(1, 1, 5), cut = header(1, 1, 5), both = header(0, 1, 5);
  magic.words[0] ^= 1;
  params.words[2] ^= 0x80;
  both.words[0] ^= 0x10000;
  cut.cut = cut.final = true;
  for (const Case& c :
       {Case{magic, ErrorCode::HEADER, 5}, Case{both, ErrorCode::HEADER, 5}, Case{header(0, 1, 5), ErrorCode::SIZE, 5},
        Case{header(1, 0, 5), ErrorCode::SIZE, 5}, Case{header(kMaxWidth + 1, 1, 5), ErrorCode::SIZE, 5},
        Case{header(1, 32768, 5), ErrorCode::SIZE, 5}, Case{params, ErrorCode::PARAMS, 5},
        Case{cut, ErrorCode::LAST_EARLY, 0}}) {
    each_seed(4, [&](Dice& dice) {
      const Outcome out = run(dice, {c.header, header(kMaxWidth, 1, 6), kEol0, kEnd});
      REQUIRE(out.errors ==
              std::vector<std::array<std::uint32_t, 4>>{{static_cast<std::uint32_t>(c.code), c.frame, 0, 0}});
      REQUIRE(out.lines.size() == 1);
      REQUIRE(out.frames == 2);
      REQUIRE(out.drops == (c.header.final ? 0 : 1));
    });
  }
}
