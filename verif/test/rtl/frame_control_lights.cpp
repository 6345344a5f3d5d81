// SPDX-License-Identifier: Apache-2.0
// frame_control with counters of three lights, a table of 5 bits of class, and translucency: what ES, TABLE and a first
// TP become, and their errors. Otherwise the default configuration, MAX_WIDTH 64.
#include <algorithm>

#include "Vframe_control_lights.h"
#include "frame_control_bench.hpp"
#include "kage/stream.hpp"

using namespace kage::rtl;
using kage::ErrorCode;
using kage::Kind;

namespace {

constexpr kage::Config kLights = config_of<Vframe_control_lights>();

/// A token of the lights configuration, as `write` writes it.
template <class Write>
Token lights_token(Write write) {
  std::vector<std::uint32_t> words;
  kage::TokenWriter writer(kLights, words);
  write(writer);
  Token t;
  std::copy(words.begin(), words.end(), t.words.begin());
  t.final = kage::kind_of(words[0]) == Kind::END;
  t.at_last = true;
  return t;
}

const Token kEol0 = token(Kind::EOL, 0);
const Token kEol1 = token(Kind::EOL, 1);
const Token kEnd = token(Kind::END);

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
          "[frame_control_lights]") {
  each_seed(20, [](Dice& dice) {
    const Token nc = token(Kind::NC, 0, 20, 1), ev = token(Kind::EV, 0, 20), resolve = token(Kind::RESOLVE);
    const auto sample = [&](int xl, int xr, int light) {
      return std::vector<Token>{nc, ev, sample_end(xl, xr, light)};
    };
    const std::vector<Token> table{header(20, 3, 7, kLights), lights_entry(1, 0, 5), lights_entry(1, 1, 256),
                                   lights_entry(1, 2, 7), lights_entry(2, 0, 1)};
    const std::vector<Token> surfaces{lights_op(0, 20, 1), lights_op(1, 2, 0)};
    const std::vector<Token> glass{resolve, kLightsTp, kLightsTp, kEol0};
    const std::vector<Token> second{lights_op(0, 1, 0), kLightsTp, kEol1};
    const std::vector<Token> end{resolve, token(Kind::EOL, 2), kEnd};
    const auto out = run<Vframe_control_lights>(dice,
                                                table + surfaces + sample(1, 19, 2) + sample(5, 5, 0) +
                                                    sample(0, 20, 1) + glass + second + sample(2, 3, 0) + end,
                                                false);
    REQUIRE(out.errors.empty());
    const auto three = [](std::uint64_t share) { return share | share << 9 | share << 18; };
    REQUIRE(out.table == std::vector<Entry>{{1, 0, three(5)}, {1, 1, three(256)}, {1, 2, three(7)}, {2, 0, three(1)}});
    REQUIRE(out.commands == std::vector<Command>{{Kind::OP, 0, 20, 1},
                                                 {Kind::OP, 1, 2, 0},
                                                 {Kind::NC, 0, 20, 1},
                                                 {Kind::EV, 0, 20, 0},
                                                 {Kind::ES, 1, 19, 2},
                                                 {Kind::NC, 0, 20, 1},
                                                 {Kind::EV, 0, 20, 0},
                                                 {Kind::NC, 0, 20, 1},
                                                 {Kind::EV, 0, 20, 0},
                                                 {Kind::ES, 0, 20, 1},
                                                 {kage::derived::kCommandOut, 0, 20, 0},
                                                 {Kind::TP, 3, 9, 0},
                                                 {Kind::TP, 3, 9, 0},
                                                 {Kind::EOL, 0, 20, 0},
                                                 {Kind::OP, 0, 1, 0},
                                                 {Kind::RESOLVE, 0, 20, 0},
                                                 {Kind::TP, 3, 9, 0},
                                                 {Kind::EOL, 0, 20, 0},
                                                 {Kind::NC, 0, 20, 1},
                                                 {Kind::EV, 0, 20, 0},
                                                 {Kind::ES, 2, 3, 0},
                                                 {Kind::EOL, 0, 20, 0}});
    REQUIRE(out.loads == std::vector<bool>{true, false, false, false});
    REQUIRE(out.painted == std::vector<bool>{false, true, true, false});
  });
}

TEST_CASE("TABLE in order, whole classes only; ES once a sample, RESOLVE after it", "[frame_control_lights]") {
  const auto expect = [](const std::vector<Token>& body, ErrorCode code, std::uint32_t index) {
    each_seed(4, [&](Dice& dice) {
      CAPTURE(static_cast<int>(code), index);
      const std::vector<Token> start{header(20, 1, 7, kLights)};
      const auto out = run<Vframe_control_lights>(dice, start + body + std::vector<Token>{kEnd}, false);
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
