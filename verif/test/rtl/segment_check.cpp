// SPDX-License-Identifier: Apache-2.0
// segment_check against docs/stream.md ("Order in a line", "Units and the tree"): random frames, sound and not, token
// by token, asked any number of times before they are taken.
#include <map>
#include <optional>
#include <set>

#include "Vcheck1.h"
#include "Vcheck3.h"
#include "Vcheck6.h"
#include "Vcheck64.h"
#include "bench.hpp"
#include "contract/derived.hpp"
#include "kage/defs.hpp"

using namespace kage::rtl;

namespace {

struct Shape : kage::Config {
  int blank() const { return (1 << face_bits) - 1; }
  int longest() const { return (1 << dx_bits) - 1; }
  int most() const { return 1 << seg_bits; }
  int unit_bits() const { return kage::derived::unit_bits(*this); }
};

enum Kind { kShade, kFace, kSeg, kTree, kEol, kOther };
using Code = kage::ErrorCode;

struct Token {
  Kind kind;
  int unit = 0, face = 0, sync = 0, dx = 0;
};

struct Verdict {
  Code code = Code::NONE;
  int unit = 0;
  std::uint32_t token = 0;
  bool pass = false;       // a segment goes to its unit
  bool completes = false;  // and ends the unit's line
};

/// The rules, told in lines of the frame and a list of all faults.
class Rules {
 public:
  struct Unit {
    int faces = 0, lines = 0, sum = 0, segments = 0;
    bool fault = false;
  };
  struct Fault {
    int line, unit;
    Code code;
    std::uint32_t token;
  };

  Rules(const Shape& shape, int width, int height)
      : width(width), height(height), units(static_cast<std::size_t>(shape.units)), shape_(shape) {}

  Verdict judge(const Token& t, std::uint32_t index) const {
    Verdict v;
    const bool exists = t.unit < shape_.units;
    const Unit* unit = exists ? &units[static_cast<std::size_t>(t.unit)] : nullptr;
    switch (t.kind) {
      case kShade:
        if (begun) v.code = Code::ORDER;
        break;
      case kFace:
        if (begun)
          v.code = Code::ORDER;
        else if (!exists || t.face != unit->faces || t.face == shape_.blank())
          v.code = Code::RANGE;
        break;
      case kSeg:
        if (begun && !due)
          v.code = Code::ORDER;
        else if (exists && unit->lines == height)
          v.code = Code::ORDER;
        else if (!exists)
          v.code = Code::RANGE;
        else {
          v.pass = !unit->fault && !fault_of(t);
          v.completes = unit->sum + t.dx == width;
        }
        break;
      case kTree:
        if (!due)
          v.code = Code::ORDER;
        else
          judge_tree(v, index);
        break;
      case kEol:
      case kOther:
        if (due) v.code = Code::ORDER;
    }
    return v;
  }

  void take(const Token& t, std::uint32_t index) {
    if (t.kind == kFace) ++units[static_cast<std::size_t>(t.unit)].faces;
    if (t.kind == kSeg) {
      Unit& unit = units[static_cast<std::size_t>(t.unit)];
      if (!begun) tree = true;
      due = true;
      if (const auto fault = fault_of(t); fault && !unit.fault) {
        faults.push_back({fault->first, t.unit, fault->second, index});
        unit.fault = true;
      } else if (!unit.fault) {
        unit.sum += t.dx;
        ++unit.segments;
        if (unit.sum == width) {
          ++unit.lines;
          unit.sum = unit.segments = 0;
        }
      }
    }
    if (t.kind == kTree) due = false;
    if (t.kind == kEol) {
      ++line;
      due = tree;
    }
    if (t.kind != kShade && t.kind != kFace) begun = true;
  }

  int width, height, line = 0;
  std::vector<Unit> units;
  std::vector<Fault> faults;
  bool begun = false, tree = false, due = false;  // begun: something other than SHADE and FACE has come

 private:
  /// The fault of a segment, and its line.
  std::optional<std::pair<int, Code>> fault_of(const Token& t) const {
    const Unit& unit = units[static_cast<std::size_t>(t.unit)];
    if (unit.lines > line + 1) return {{line + 1, Code::UNIT_LONG}};
    if ((t.sync == 1) != (unit.segments == 0)) return {{unit.lines, Code::SEGMENT}};
    if (t.dx == 0) return {{unit.lines, Code::SEGMENT}};
    if (t.face != shape_.blank() && t.face >= unit.faces) return {{unit.lines, Code::SEGMENT}};
    if (unit.sum + t.dx > width) return {{unit.lines, Code::UNIT_LONG}};
    if (unit.segments == shape_.most()) return {{unit.lines, Code::UNIT_LONG}};
    return std::nullopt;
  }

  void judge_tree(Verdict& v, std::uint32_t index) const {
    const Fault* first = nullptr;
    for (const Fault& fault : faults)
      if (fault.line <= line && (first == nullptr || fault.token < first->token)) first = &fault;
    if (first != nullptr) {
      v = {first->code, first->unit, first->token, false};
      return;
    }
    for (int u = 0; u < shape_.units; ++u) {
      if (units[static_cast<std::size_t>(u)].lines > line) continue;
      v = {Code::UNIT_SHORT, u, index, false};
      return;
    }
  }

  Shape shape_;
};

/// A token that fits.
Token fitting_token(Dice& dice, const Shape& s, const Rules& rules, int eager) {
  Token t{kOther};
  const auto pick = [&](auto fits) -> int {
    std::vector<int> found;
    for (int u = 0; u < s.units; ++u)
      if (fits(rules.units[static_cast<std::size_t>(u)])) found.push_back(u);
    return found.empty() ? -1 : found[static_cast<std::size_t>(dice.below(static_cast<int>(found.size())))];
  };
  const auto segment = [&](int u) {
    const auto& unit = rules.units[static_cast<std::size_t>(u)];
    const int room = rules.width - unit.sum;
    const int left = s.most() - unit.segments;
    const int low = std::max(1, room - (left - 1) * s.longest());
    const int high = std::min(s.longest(), room);
    t = {kSeg, u, dice.percent(50) ? s.blank() : dice.below(unit.faces + 1), unit.segments == 0, 0};
    if (t.face == unit.faces) t.face = s.blank();
    t.dx = low > high ? 1 : dice.percent(30) ? low : dice.percent(30) ? high : dice.between(low, high);
  };
  const bool ahead = rules.due || !rules.begun;
  if (!rules.begun && dice.percent(60)) {
    const int u = pick([&](const auto& unit) { return unit.faces < s.blank(); });
    if (u >= 0)
      t = {kFace, u, rules.units[static_cast<std::size_t>(u)].faces};
    else
      t.kind = kShade;
  } else if (ahead && !(!rules.begun && dice.percent(10))) {
    const int here = pick([&](const auto& unit) { return unit.lines <= rules.line && !unit.fault; });
    const int next = pick(
        [&](const auto& unit) { return unit.lines <= rules.line + 1 && unit.lines < rules.height && !unit.fault; });
    const int broken = pick([](const auto& unit) { return unit.fault; });
    if (broken >= 0 && dice.percent(20))
      segment(broken);  // swallowed
    else if (next >= 0 && dice.percent(eager))
      segment(next);
    else if (here >= 0)
      segment(here);
    else
      t.kind = kTree;
  } else {
    t.kind = dice.percent(70) ? kEol : kOther;
  }
  return t;
}

/// Something of a token is changed.
void spoil(Dice& dice, const Shape& s, Token& t) {
  switch (dice.below(9)) {
    case 0:
      t.kind = static_cast<Kind>(dice.below(6));
      break;
    case 1:
      t.unit = dice.below(1 << s.unit_bits());
      break;
    case 2:
      t.face = dice.below(s.blank() + 1);
      break;
    case 3:
      t.sync ^= 1;
      break;
    case 4:
      t.dx = dice.percent(25) ? 0 : dice.percent(50) ? s.longest() : dice.below(s.longest() + 1);
      break;
    case 5:
      t.dx = 1;
      break;
    case 7:
      t = {kFace, dice.below(1 << s.unit_bits()), dice.below(s.blank() + 1)};
      break;
    case 6:
      t = {kSeg, dice.below(s.units), s.blank(), dice.below(2), dice.below(s.longest() + 1)};
      break;
    default:
      t.kind = kTree;
  }
}

/// A token that fits, mostly; `wrong` percent of them have something changed.
Token random_token(Dice& dice, const Shape& s, const Rules& rules, int wrong, int eager) {
  Token t = fitting_token(dice, s, rules, eager);
  if (dice.percent(wrong)) spoil(dice, s, t);
  return t;
}

template <class Top>
void ask(Top& top, const Token& t, const Rules& rules, std::uint32_t index) {
  top.is_shade_i = t.kind == kShade;
  top.is_face_i = t.kind == kFace;
  top.is_seg_i = t.kind == kSeg;
  top.is_tree_i = t.kind == kTree;
  top.is_eol_i = t.kind == kEol;
  top.is_other_i = t.kind == kOther;
  top.width_i = static_cast<SData>(rules.width);
  top.lines_left_i = static_cast<SData>(rules.height - rules.line);
  top.token_i = index;
  top.unit_i = static_cast<CData>(t.unit);
  top.face_i = static_cast<CData>(t.face);
  top.sync_i = t.sync != 0;
  top.dx_i = static_cast<SData>(t.dx);
}

template <class Top>
void silent(Top& top, Dice& dice) {
  top.is_shade_i = top.is_face_i = top.is_seg_i = top.is_tree_i = top.is_eol_i = top.is_other_i = 0;
  top.take_i = 0;
  top.frame_start_i = 0;
  top.unit_i = static_cast<CData>(dice.bits(1));
  top.token_i = static_cast<IData>(dice.bits(32));
}

/// Counts of what came, over all seeds.
struct Seen {
  std::map<Code, int> codes;
  int sound = 0, later = 0, crowds = 0, swallowed = 0;

  void note(const Verdict& want, const Rules& rules, std::uint32_t index) {
    ++codes[want.code];
    if (want.code < Code::SEGMENT) return;
    if (want.code != Code::UNIT_SHORT && want.token + 1 < index) ++later;
    std::set<int> at_fault;
    for (const auto& fault : rules.faults)
      if (fault.line == rules.line) at_fault.insert(fault.unit);
    if (at_fault.size() > 1) ++crowds;
  }
};

/// Frames of random tokens, each held against the rules until one is wrong.
template <class Model>
class Frames {
 public:
  Frames(Dice& dice, Seen& seen) : dice_(dice), seen_(seen), top_(dice) {
    silent(*top_, dice_);
    stall_ = stall_percent(dice_);
  }

  void frame(int number) {
    const int widest = std::min((1 << kOf.x_bits) - 1, kOf.most() * kOf.longest());
    Rules rules(kOf, dice_.percent(20) ? widest : dice_.between(1, widest), dice_.between(1, 6));
    static constexpr int kWrong[] = {0, 1, 5, 20};
    const int wrong = kWrong[dice_.below(4)];
    const int eager = dice_.below(80);
    silent(*top_, dice_);
    top_->frame_start_i = 1;
    clock();
    for (std::uint32_t index = 1; rules.line < rules.height; ++index) {
      const Token t = random_token(dice_, kOf, rules, wrong, eager);
      const Verdict want = rules.judge(t, index);
      INFO("frame " << number << " token " << index << " kind " << t.kind << " unit " << t.unit << " line "
                    << rules.line);
      do {  // the answer stands as long as the token waits
        if (dice_.percent(stall_)) {
          silent(*top_, dice_);
          top_.settle();
          top_.edge();
        }
        ask(*top_, t, rules, index);
        top_.settle();
        look(t, rules, want);
        if (dice_.percent(stall_)) top_.edge();
      } while (dice_.percent(stall_));
      seen_.note(want, rules, index);
      if (want.code != Code::NONE) break;
      if (t.kind == kSeg && !want.pass) ++seen_.swallowed;
      rules.take(t, index);
      top_->take_i = 1;
      clock();
    }
    if (rules.line == rules.height && rules.tree) ++seen_.sound;
  }

 private:
  static constexpr Shape kOf{config_of<Model>()};

  /// The inputs that were set are taken; then there are none.
  void clock() {
    top_.settle();
    top_.edge();
    silent(*top_, dice_);
  }

  void look(const Token& t, const Rules& rules, const Verdict& want) {
    REQUIRE(top_->tree_o == (rules.tree ? 1 : 0));
    REQUIRE(top_->due_o == (rules.due ? 1 : 0));
    Code code = Code::NONE;
    if (top_->order_error_o)
      code = Code::ORDER;
    else if (top_->range_error_o)
      code = Code::RANGE;
    else if (top_->tree_error_o)
      code = static_cast<Code>(top_->tree_code_o);
    REQUIRE(code == want.code);
    if (code >= Code::SEGMENT) {
      REQUIRE(top_->tree_unit_o == want.unit);
      REQUIRE(top_->tree_token_o == want.token);
    }
    if (t.kind == kSeg && code == Code::NONE) {
      REQUIRE(top_->seg_pass_o == (want.pass ? 1 : 0));
      if (want.pass) REQUIRE(top_->completes_o == (want.completes ? 1 : 0));
    }
  }

  Dice& dice_;
  Seen& seen_;
  Bench<Model> top_;
  int stall_ = 0;
};

template <class Model>
void check_test(int frames) {
  Seen seen;
  each_seed(10, [&](Dice& dice) {
    Frames<Model> run(dice, seen);
    for (int frame = 0; frame < frames; ++frame) run.frame(frame);
  });
  if (std::getenv("KAGE_SEED") != nullptr) return;
  // The frames were of all kinds.
  for (const Code code : {Code::ORDER, Code::RANGE, Code::SEGMENT, Code::UNIT_LONG, Code::UNIT_SHORT}) {
    INFO("code " << kage::kErrorNames[static_cast<std::size_t>(code)]);
    REQUIRE(seen.codes[code] > 0);
  }
  REQUIRE(seen.sound > 20);
  REQUIRE(seen.later > 10);
  REQUIRE(seen.swallowed > 20);
  if (config_of<Model>().units > 1) REQUIRE(seen.crowds > 3);
}

}  // namespace

TEST_CASE("segment_check, 1 unit", "[segment_check]") { check_test<Vcheck1>(150); }
TEST_CASE("segment_check, 3 units", "[segment_check]") { check_test<Vcheck3>(150); }
TEST_CASE("segment_check, 6 units", "[segment_check]") { check_test<Vcheck6>(150); }
TEST_CASE("segment_check, 64 units", "[segment_check]") { check_test<Vcheck64>(120); }
