// SPDX-License-Identifier: Apache-2.0
//
// Shared parts of the tests of frame_control: tokens as token_reader gives them, and what they become under any stalls.
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

/// Tokens go in under stalls at random; what becomes of them is noted.
template <class Model>
class Run {
 public:
  /// `fields`: spans have the fields that token() gives them.
  Run(Dice& dice, const std::vector<Token>& tokens, bool fields)
      : dice_(dice),
        tokens_(tokens),
        fields_(fields),
        top_(dice),
        offer_(stall_percent(dice)),
        cmd_stall_(stall_percent(dice)),
        line_stall_(stall_percent(dice)),
        table_stall_(stall_percent(dice)) {}

  Outcome outcome() {
    for (int clock = 0; quiet_ < 200; ++clock) {
      REQUIRE(clock < 100000);
      drive();
      if (loading_ > 0) hold_while_loading();
      if (top_->table_valid_o) note_entry();
      if (top_->cmd_valid_o && top_->cmd_ready_i) note_command();
      if (top_->line_valid_o) note_line();
      if (top_->error_valid_o) note_error();
      if (top_->frame_end_o) ++out_.frames;
      edge();
    }
    REQUIRE(at_ == tokens_.size());
    REQUIRE(!top_->open_o);
    return out_;
  }

 private:
  static constexpr kage::Config kOf = config_of<Model>();
  static constexpr FlagsBus kFlags{kOf};
  static constexpr CommandBus kCommand{kOf};
  static constexpr LineBus kLine{kOf};
  static constexpr TableEntryBus kEntry{kOf};
  static constexpr ErrorBus kError{kOf};

  void drive() {
    const bool offered = dropping_ == 0 && offer_(dice_, at_ < tokens_.size());
    top_->token_valid_i = offered ? 1 : 0;
    if (offered) {
      const Token& t = tokens_[at_];
      for (int i = 0; i < 5; ++i) put(top_->token_i, 32 * i, 32, t.words[static_cast<std::size_t>(i)]);
      put(top_->token_flags_i, kFlags.header, t.header ? 1 : 0);
      put(top_->token_flags_i, kFlags.lacking, t.lacking ? 1 : 0);
      put(top_->token_flags_i, kFlags.cut, t.cut ? 1 : 0);
      put(top_->token_flags_i, kFlags.ends, t.final ? 1 : 0);
      put(top_->token_flags_i, kFlags.at_last, t.at_last ? 1 : 0);
      put(top_->token_flags_i, kFlags.fault, 0);
    }
    top_->dropping_i = dropping_ > 0 ? 1 : 0;
    top_->cmd_ready_i = dice_.percent(cmd_stall_) ? 0 : 1;
    top_->line_ready_i = dice_.percent(line_stall_) ? 0 : 1;
    top_->table_free_i = dice_.percent(table_stall_) ? 0 : 1;
    top_->loads_done_i = loading_ == 1 ? 1 : 0;
    top_.settle();
  }

  void hold_while_loading() {
    REQUIRE_FALSE(top_->cmd_valid_o);
    REQUIRE_FALSE(top_->line_valid_o);
    // Behind the TP that waits there is room for one token more.
    if (top_->token_valid_i && top_->token_ready_o) REQUIRE(++came_in_ == 1);
    if (--loading_ == 0) came_in_ = 0;
  }

  void note_entry() {
    REQUIRE(top_->table_free_i);
    out_.table.push_back({static_cast<unsigned>(get(top_->table_o, kEntry.normal_class)),
                          static_cast<unsigned>(get(top_->table_o, kEntry.light)), get(top_->table_o, kEntry.share)});
  }

  void note_command() {
    const auto field = [&](const Place& p) { return static_cast<unsigned>(get(top_->cmd_o, p)); };
    const auto kind = static_cast<Kind>(field(kCommand.kind));
    if (kind == kage::derived::kCommandOut) loading_ = dice_.between(1, 20);
    // TP has no count.
    out_.commands.push_back(
        {kind, field(kCommand.xl), field(kCommand.xr), kind == Kind::TP ? 0U : field(kCommand.count)});
    out_.shares.push_back(field(kCommand.share));
    const auto ramp = [&](std::uint64_t z, std::uint64_t dz) {
      REQUIRE(get(top_->cmd_o, kCommand.z) == z);
      REQUIRE(get(top_->cmd_o, kCommand.dz) == dz);
    };
    if (kind == Kind::SP) ramp(0x11111111, 0x22222222);
    if (kind == Kind::OP && fields_) ramp(0x123456789, 0x0FEDCBA98);
    if (kind == Kind::TP && fields_) ramp(0x0F1234567, 0x0A9876543);
    if (kind == Kind::OP && fields_) REQUIRE(field(kCommand.color) == 0x332211);
    if (kind == Kind::TP && fields_) REQUIRE(field(kCommand.color) == 0x665544);
    if (kind == Kind::RESOLVE) REQUIRE(field(kCommand.color) == 0x0A0B0C);
  }

  void note_line() {
    REQUIRE(top_->line_ready_i);
    const auto field = [&](const Place& p) { return static_cast<unsigned>(get(top_->line_o, p)); };
    out_.lines.push_back({field(kLine.first) != 0, field(kLine.blank) != 0, field(kLine.width), field(kLine.background),
                          field(kLine.shade)});
    out_.painted.push_back(field(kLine.painted) != 0);
    out_.loads.push_back(field(kLine.load) != 0);
  }

  void note_error() {
    const auto field = [&](const Place& p) { return static_cast<std::uint32_t>(get(top_->error_o, p)); };
    out_.errors.push_back({field(kError.code), field(kError.frame), field(kError.line), field(kError.token)});
  }

  /// After a drop the tokens up to the next header do not come.
  void edge() {
    if (dropping_ > 0) --dropping_;
    const bool taken = top_->token_valid_i && top_->token_ready_o;
    if (top_->drop_o) {
      REQUIRE(taken);
      REQUIRE(!tokens_[at_].final);
      ++out_.drops;
      dropping_ = dice_.between(1, 9);
    }
    quiet_ = taken || top_->cmd_valid_o || top_->line_valid_o ? 0 : quiet_ + 1;
    top_.edge();
    if (!taken) return;
    offer_.taken();
    ++at_;
    while (dropping_ > 0 && at_ < tokens_.size() && !tokens_[at_].header) ++at_;
  }

  Dice& dice_;
  const std::vector<Token>& tokens_;
  bool fields_;
  Bench<Model> top_;
  Offer offer_;
  int cmd_stall_, line_stall_, table_stall_;
  Outcome out_;
  int dropping_ = 0;
  int loading_ = 0;  // clocks until the loads of a line have come back
  int came_in_ = 0;  // tokens in that time
  int quiet_ = 0;    // clocks in which nothing moved
  std::size_t at_ = 0;
};

template <class Model>
Outcome run(Dice& dice, const std::vector<Token>& tokens, bool fields = true) {
  return Run<Model>(dice, tokens, fields).outcome();
}

inline std::vector<Token> operator+(std::vector<Token> a, const std::vector<Token>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace kage::rtl
