// SPDX-License-Identifier: Apache-2.0
// frame_control: the commands and lines that a frame becomes, and each error with its code, line and token. Default
// configuration (X_BITS 11, Z 24.11, three flat channels, DSF_BITS 1, FSF), MAX_WIDTH 64.
#include <array>

#include "Vframe_control.h"
#include "Vframe_control_glass.h"
#include "frame_control_bench.hpp"

using namespace kage::rtl;
using kage::ErrorCode;
using kage::Kind;

namespace {

/// Runs a frame of 2 lines that begins with `body`, whose last token is at fault, and goes on with `rest`. Checks the
/// error, that the rest is blank, and that the next frame is none the worse.
void expect_rest(const std::vector<Token>& body, const std::vector<Token>& rest, ErrorCode code, unsigned line,
                 unsigned index) {
  constexpr unsigned height = 2;
  each_seed(3, [&](Dice& dice) {
    CAPTURE(static_cast<int>(code), line, index, rest.size());
    const std::vector<Token> next = {header(1, 1, 8), token(Kind::EOL, 0), token(Kind::END)};
    const auto out = run<Vframe_control>(dice, std::vector<Token>{header(20, height, 7)} + body + rest + next);
    REQUIRE(out.errors.size() == 1);
    REQUIRE(out.errors[0] == std::array<std::uint32_t, 4>{static_cast<std::uint32_t>(code), 7, line, index});
    REQUIRE(out.frames == 2);
    // The reader drops nothing more behind a token that ends the frame, be it the one at fault or the one behind it.
    REQUIRE(out.drops == (body.back().final || rest.front().final ? 0 : 1));
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

Token cut_token(Kind kind) {
  Token t = token(kind, 0, 20);
  t.cut = t.final = true;
  return t;
}

Token late_end() {
  Token t = kEnd;
  t.at_last = false;
  return t;
}

/// As expect_rest, with each kind of token right behind the token at fault, while it is still in token_stage: a good
/// and a bad EOL, END, and a cut token. Each comes alone and, where there can be more, with more behind it.
void expect_error(const std::vector<Token>& body, ErrorCode code, unsigned line, unsigned index) {
  if (body.back().final) {
    expect_rest(body, {}, code, line, index);
    return;
  }
  const Token op = token(Kind::OP, 0, 1), good_eol = token(Kind::EOL, line), bad_eol = token(Kind::EOL, line + 1);
  const std::vector<std::vector<Token>> rests = {{kEnd},
                                                 {late_end()},
                                                 {cut_token(Kind::OP)},
                                                 {cut_token(Kind::END)},
                                                 {cut_token(Kind::EOL)},
                                                 {op},
                                                 {good_eol, op},
                                                 {bad_eol, op},
                                                 {good_eol, kEnd},
                                                 {bad_eol, kEnd},
                                                 {op, kEnd},
                                                 {op, cut_token(Kind::SP)}};
  for (const std::vector<Token>& rest : rests) expect_rest(body, rest, code, line, index);
}

}  // namespace

TEST_CASE("A frame becomes commands and lines; bias goes with EV and is cleared by it", "[frame_control]") {
  each_seed(20, [](Dice& dice) {
    const auto out = run<Vframe_control>(
        dice, {header(20, 2, 7), token(Kind::SHADE, 256), token(Kind::OP, 3, 9, 1), token(Kind::OP, 4, 4, 1),
               token(Kind::SP, 0, 20, 1), token(Kind::IF, 1), token(Kind::EV, 1, 19),
               token(Kind::NC, 2, 3, static_cast<std::uint64_t>(-1)), token(Kind::EV, 0, 20), token(Kind::RESOLVE),
               kEol0, token(Kind::OP, 19, 20, 0), kEol1, kEnd});
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
      const std::vector<Token> start{header(20, 1, 7, kGlass)};
      const auto out = run<Vframe_control_glass>(dice, start + body + std::vector<Token>{kEnd});
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

TEST_CASE("SHADE holds for its frame only", "[frame_control]") {
  each_seed(5, [](Dice& dice) {
    const auto out =
        run<Vframe_control>(dice, {header(1, 1, 1), token(Kind::SHADE, 9), kEol0, kEnd, header(1, 1, 2), kEol0, kEnd});
    REQUIRE(out.lines.size() == 2);
    REQUIRE(out.lines[0].shade == 9);
    REQUIRE(out.lines[1].shade == 0);
  });
}

TEST_CASE("Errors of kind, order, range and line, each at its place", "[frame_control]") {
  Token lacking = token(static_cast<Kind>(2));
  lacking.lacking = true;
  const Token cut = cut_token(Kind::OP);
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
  expect_error({kEnd}, ErrorCode::LINE, 0, 1);
  expect_error({kEol0, token(Kind::SP, 0, 1), kEnd}, ErrorCode::LINE, 1, 3);
  expect_error({kEol0, kEol1, late_end()}, ErrorCode::LAST_LATE, 2, 3);
}

TEST_CASE("The earlier check wins: kind, order, range", "[frame_control]") {
  expect_error({token(Kind::SP, 0, 1), token(Kind::OP, 9, 99)}, ErrorCode::ORDER, 0, 2);
  expect_error({cut_token(Kind::EV)}, ErrorCode::LAST_EARLY, 0, 1);  // not whole: its order is not checked
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
      const std::vector<Token> rest = c.header.final ? std::vector<Token>{} : std::vector<Token>{kEol0, kEnd};
      const std::vector<Token> next = {header(kMaxWidth, 1, 6), kEol0, kEnd};
      const auto out = run<Vframe_control>(dice, std::vector<Token>{c.header} + rest + next);
      REQUIRE(out.errors ==
              std::vector<std::array<std::uint32_t, 4>>{{static_cast<std::uint32_t>(c.code), c.frame, 0, 0}});
      REQUIRE(out.lines.size() == 1);
      REQUIRE(out.frames == 2);
      REQUIRE(out.drops == (c.header.final ? 0 : 1));
    });
  }
}
