// SPDX-License-Identifier: Apache-2.0
//
// What the tests of frame_control share: tokens as token_reader gives them, and what they become under any stalls.
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "bench.hpp"
#include "contract/derived.hpp"
#include "kage/stream.hpp"

namespace kage::rtl {

inline constexpr kage::Config kConfig = config_of<Vframe_control>();
inline constexpr kage::Config kGlass = config_of<Vframe_control_glass>();
inline constexpr int kMaxWidth = kConfig.max_width;

struct Token {
  std::array<std::uint32_t, 5> words{};
  bool header = false, lacking = false, cut = false, final = false, at_last = false;
};

/// A token, or the header, by what `write` does to a TokenWriter of the configuration.
template <class Write>
Token written(const kage::Config& config, Write&& write) {
  std::vector<std::uint32_t> words;
  kage::TokenWriter writer(config, words);
  write(writer);
  Token t;
  if (words.size() > t.words.size()) throw std::length_error("a token of too many words");
  std::copy(words.begin(), words.end(), t.words.begin());
  t.at_last = true;
  return t;
}

inline Token header(std::uint32_t width, std::uint32_t height, std::uint32_t frame,
                    const kage::Config& config = kConfig) {
  Token t = written(config, [&](kage::TokenWriter& w) {
    w.header({static_cast<int>(width), static_cast<int>(height), 0x0A0B0C, frame});
  });
  t.header = true;
  t.at_last = false;
  return t;
}

/// SHADE, EOL, IF: `a` is what they hold. OP, SP, TP, NC, EV: pixels [a, b); c is OP's class, SP's and NC's w, TP's
/// alpha; depth, slope and colour are some. Others: nothing.
inline Token token(Kind kind, std::uint64_t a = 0, std::uint64_t b = 0, std::uint64_t c = 0) {
  const auto number = [](std::uint64_t v) { return static_cast<int>(v); };
  kage::SpanToken s;
  s.xl = number(a);
  s.xr = number(b);
  Token t = written(kind == Kind::TP ? kGlass : kConfig, [&](kage::TokenWriter& w) {
    switch (kind) {
      case Kind::SHADE:
        return w.shade(static_cast<std::uint32_t>(a));
      case Kind::EOL:
        return w.eol(number(a));
      case Kind::IF:
        return w.inside(number(a));
      case Kind::OP:
        s.normal_class = number(c);
        s.z = 0x123456789;
        s.dz = 0x0FEDCBA98;
        s.color = {0x11, 0x22, 0x33};
        return w.op(s);
      case Kind::SP:
        s.w = number(c);
        s.z = 0x11111111;
        s.dz = 0x22222222;
        return w.sp(s);
      case Kind::TP:
        s.alpha = number(c);
        s.z = 0x0F1234567;
        s.dz = 0x0A9876543;
        s.color = {0x44, 0x55, 0x66};
        return w.tp(s);
      case Kind::NC:
        return w.nc(number(a), number(b), number(c));
      case Kind::EV:
        return w.ev(number(a), number(b));
      default:
        break;
    }
  });
  if (t.words[0] == 0) t.words[0] = static_cast<std::uint32_t>(kind);
  t.final = kind == Kind::END;
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

/// `fields`: spans have the fields that token() gives them.
template <class Model>
Outcome run(Dice& dice, const std::vector<Token>& tokens, bool fields = true) {
  Bench<Model> top(dice);
  constexpr kage::Config config = config_of<Model>();
  const CommandBus command(config);
  const LineBus line(config);
  const TableEntryBus entry(config);
  const ErrorBus error(config);
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
      out.table.push_back({static_cast<unsigned>(get(top->table_o, entry.normal_class)),
                           static_cast<unsigned>(get(top->table_o, entry.light)), get(top->table_o, entry.share)});
    }
    if (top->cmd_valid_o && top->cmd_ready_i) {
      const auto field = [&](const Place& p) { return static_cast<unsigned>(get(top->cmd_o, p)); };
      const auto kind = static_cast<Kind>(field(command.kind));
      if (kind == kage::derived::kCommandOut) loading = dice.between(1, 20);
      // TP has no count.
      out.commands.push_back(
          {kind, field(command.xl), field(command.xr), kind == Kind::TP ? 0U : field(command.count)});
      out.shares.push_back(field(command.share));
      const auto ramp = [&](std::uint64_t z, std::uint64_t dz) {
        REQUIRE(get(top->cmd_o, command.z) == z);
        REQUIRE(get(top->cmd_o, command.dz) == dz);
      };
      if (kind == Kind::SP) ramp(0x11111111, 0x22222222);
      if (kind == Kind::OP && fields) ramp(0x123456789, 0x0FEDCBA98);
      if (kind == Kind::TP && fields) ramp(0x0F1234567, 0x0A9876543);
      if (kind == Kind::OP && fields) REQUIRE(field(command.color) == 0x332211);
      if (kind == Kind::TP && fields) REQUIRE(field(command.color) == 0x665544);
      if (kind == Kind::RESOLVE) REQUIRE(field(command.color) == 0x0A0B0C);
    }
    if (top->line_valid_o) {
      REQUIRE(top->line_ready_i);
      const auto field = [&](const Place& p) { return static_cast<unsigned>(get(top->line_o, p)); };
      out.lines.push_back({field(line.first) != 0, field(line.blank) != 0, field(line.width), field(line.background),
                           field(line.shade)});
      out.painted.push_back(field(line.painted) != 0);
      out.loads.push_back(field(line.load) != 0);
    }
    if (top->error_valid_o) {
      const auto field = [&](const Place& p) { return static_cast<std::uint32_t>(get(top->error_o, p)); };
      out.errors.push_back({field(error.code), field(error.frame), field(error.line), field(error.token)});
    }
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

inline std::vector<Token> operator+(std::vector<Token> a, const std::vector<Token>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace kage::rtl
