// SPDX-License-Identifier: Apache-2.0
// kage_top with expansion units, at its ports: what kage_top.cpp demands of cores without; errors of units and whom the
// tree waits for, as the registers tell them.
#include <algorithm>
#include <numeric>

#include "Vkage_units3.h"
#include "Vkage_units5.h"
#include "top_bench.hpp"

using namespace kage::rtl;

namespace {

/// A unit's line that is not as it should be.
struct Fault {
  enum Kind { kNone, kShort, kLong, kEmptySegment } kind = kNone;
  int unit = 0, line = 0;
};

/// A frame with a tree: three segments a line of each unit, the units in the order given. A line's segments come just
/// before its TREE, so that a unit may be short without the next line's being at fault.
struct TreeFrame {
  std::vector<std::uint32_t> words;
  std::vector<std::vector<std::size_t>> unit_ends;  ///< of each line: words up to the end of each unit's segments
  std::uint32_t seg = 0, tree = 0;                  ///< index of the faulty SEG, and of the TREE of its line
};

TreeFrame tree_frame(Dice& dice, const kage::Config& c, int width, int height, const std::vector<int>& order,
                     std::uint32_t number, const Fault& fault = {}, int faces = 1) {
  TreeFrame f;
  kage::TokenWriter w(c, f.words);
  std::uint32_t token = 0;
  w.header({width, height, 7, number});
  kage::SegmentToken t;
  for (t.unit = 0; t.unit < c.units; ++t.unit) {
    t.index = t.unit;
    t.color = {t.unit, 100, 200};
    for (t.face = 0; t.face < faces; ++t.face, ++token) w.face(t);
    t.face = 0;
  }
  for (int y = 0; y < height; ++y) {
    f.unit_ends.emplace_back();
    for (const int unit : order) {
      t.unit = unit;
      const bool faulty = fault.kind != Fault::kNone && fault.unit == unit && fault.line == y;
      const int first = dice.between(1, width - 2);
      const int lengths[] = {first, 1, width - first - 1};
      for (std::size_t i = 0; i < 3; ++i) {
        const bool last = i == 2;
        if (faulty && last && fault.kind == Fault::kShort) continue;
        t.sync = i == 0;
        t.dx = lengths[i] + (faulty && last && fault.kind == Fault::kLong ? 1 : 0);
        if (faulty && last && fault.kind == Fault::kEmptySegment) t.dx = 0;
        t.face = dice.percent(50) ? 0 : (1 << c.face_bits) - 1;
        t.z = dice.below(1 << (c.z_bits + c.z_frac));
        w.seg(t);
        ++token;
        if (faulty && last) f.seg = token;
      }
      f.unit_ends.back().push_back(f.words.size());
    }
    w.tree();
    ++token;
    if (fault.line == y) f.tree = token;
    w.eol(y);
    ++token;
  }
  w.end();
  return f;
}

std::vector<int> random_order(Dice& dice, int units) {
  std::vector<int> order(static_cast<std::size_t>(units));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(dice.below(static_cast<int>(i)))]);
  return order;
}

template <class Model>
void errors_test(Fault::Kind kind, kage::ErrorCode code) {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(15, [&](Dice& dice) {
    Core<Model> core(dice);
    core.write(KAGE_REG_CONTROL, KAGE_IRQ_ERROR_MASK);
    core.in.most = dice.percent(50) ? dice.below(4) : 0;
    core.out.most = dice.percent(50) ? dice.below(4) : 0;
    const int width = dice.between(3, 15);  // no segment is longer than 15
    const int height = dice.between(1, 5);
    const Fault fault{kind, dice.below(c.units), dice.below(height)};
    CAPTURE(width, height, fault.unit, fault.line);
    const auto any = random_order(dice, c.units);
    // A sound frame before and one behind: they are as ever.
    core.submit(tree_frame(dice, c, width, height, any, 4).words);
    const TreeFrame bad = tree_frame(dice, c, width, height, any, 5, fault);
    const kage::FrameStatus golden = core.submit(bad.words);
    REQUIRE(golden.error == code);
    core.submit(tree_frame(dice, c, width, height, any, 6).words);
    core.finish();
    REQUIRE(core.read(KAGE_REG_FRAMES) == 3);
    REQUIRE(core.read(KAGE_REG_ERRORS) == 1);
    REQUIRE(core.read(KAGE_REG_ERROR) == (KAGE_FIELD_IS(KAGE_ERROR_CODE, static_cast<std::uint32_t>(code)) |
                                          KAGE_FIELD_IS(KAGE_ERROR_LINE, static_cast<std::uint32_t>(fault.line))));
    REQUIRE(core.read(KAGE_REG_ERROR_FRAME) == 5);
    REQUIRE(core.read(KAGE_REG_ERROR_TOKEN) == (kind == Fault::kShort ? bad.tree : bad.seg));
    REQUIRE(core.read(KAGE_REG_ERROR_UNIT) == static_cast<std::uint32_t>(fault.unit));
    REQUIRE((core.read(KAGE_REG_IRQ) & KAGE_IRQ_ERROR_MASK) != 0);
    REQUIRE(core.bites == 1);  // the interrupt, once
    REQUIRE(core.read(KAGE_REG_TREE) == 0);
    REQUIRE((core.read(KAGE_REG_STATUS) & (KAGE_STATUS_OPEN_MASK | KAGE_STATUS_DRAINING_MASK)) == 0);
  });
}

/// Segments of some units are there, those of others are not: the lowest of these is named, the watchdog bites once,
/// and nothing is lost when the rest comes.
template <class Model>
void waiting_test() {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(20, [&](Dice& dice) {
    const int limit = dice.between(1, 50);
    const auto order = random_order(dice, c.units);
    // Lines of any width that segments have, lines shorter than the tree has levels among them.
    const TreeFrame f = tree_frame(dice, c, dice.between(3, 15), 3, order, 0);
    const int line = dice.below(3);
    const auto& ends = f.unit_ends[static_cast<std::size_t>(line)];
    // Up to the beat in which one unit's segments end; those of the next may end in it too, of the last they do not.
    const auto beat = static_cast<std::size_t>(c.beat_words);
    const auto beats_for = [&](int units) { return (ends[static_cast<std::size_t>(units) - 1] + beat - 1) / beat; };
    const std::size_t beats = beats_for(dice.between(1, c.units - 2));
    const auto there = std::count_if(ends.begin(), ends.end(), [&](std::size_t end) { return end <= beats * beat; });
    REQUIRE(there < c.units);
    const int missing = *std::min_element(order.begin() + there, order.end());
    CAPTURE(limit, there, missing, line);
    Core<Model> core(dice);
    core.write(KAGE_REG_WATCHDOG, static_cast<std::uint32_t>(limit));
    core.write(KAGE_REG_CONTROL, KAGE_IRQ_WATCHDOG_MASK);
    core.submit(f.words);
    const std::size_t all = core.beats_left();
    while (all - core.beats_left() < beats) core.clock();
    core.in.held = true;
    for (int n = 0; core.bites == 0; ++n) {
      REQUIRE(n < 200 + limit);
      core.clock();
    }
    for (int n = 0; n < 40; ++n) core.clock();
    const auto at_line = static_cast<std::uint32_t>(line);
    const auto of_unit = static_cast<std::uint32_t>(missing);
    REQUIRE(core.read(KAGE_REG_TREE) ==
            (KAGE_TREE_BEHIND_MASK | KAGE_FIELD_IS(KAGE_TREE_LINE, at_line) | KAGE_FIELD_IS(KAGE_TREE_UNIT, of_unit)));
    REQUIRE(core.read(KAGE_REG_STALL) == (KAGE_STALL_BEHIND_MASK | KAGE_FIELD_IS(KAGE_STALL_LINE, at_line) |
                                          KAGE_STALL_ON_INPUT_MASK | KAGE_FIELD_IS(KAGE_STALL_UNIT, of_unit)));
    REQUIRE((core.read(KAGE_REG_STATUS) & (KAGE_STATUS_WAITING_INPUT_MASK | KAGE_STATUS_WAITING_OUTPUT_MASK)) ==
            KAGE_STATUS_WAITING_INPUT_MASK);
    core.write(KAGE_REG_IRQ, KAGE_IRQ_WATCHDOG_MASK);
    for (int n = 0; n < 10 * limit + 100; ++n) core.clock();
    REQUIRE(core.bites == 1);
    core.in.held = false;
    core.finish();
    REQUIRE(core.bites == 1);
    REQUIRE(core.read(KAGE_REG_FRAMES) == 1);
    REQUIRE(core.read(KAGE_REG_ERRORS) == 0);
    REQUIRE(core.read(KAGE_REG_TREE) == 0);
  });
}

/// Input stops where all units have a line, which comes through units and tree before its TREE: it is on its way for
/// some clocks in which no port shows it. A limit of fewer bites once all the same.
template <class Model>
void line_on_its_way_test() {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(40, [&](Dice& dice) {
    const int limit = dice.between(1, 12);
    const auto beat = static_cast<std::size_t>(c.beat_words);
    TreeFrame f;
    std::vector<std::size_t> ends;
    for (int faces = 1; ends.empty() || ends.back() % beat != 0; ++faces) {  // till the first line's TREE begins a beat
      f = tree_frame(dice, c, dice.between(3, 15), 3, random_order(dice, c.units), 0, {}, faces);
      ends = f.unit_ends.front();
    }
    const std::size_t beats = ends.back() / beat;
    CAPTURE(limit);
    Core<Model> core(dice);
    core.write(KAGE_REG_WATCHDOG, static_cast<std::uint32_t>(limit));
    core.write(KAGE_REG_CONTROL, KAGE_IRQ_WATCHDOG_MASK);
    core.submit(f.words);
    const std::size_t all = core.beats_left();
    while (all - core.beats_left() < beats) core.clock();
    core.in.held = true;
    for (int n = 0; core.bites == 0; ++n) {
      REQUIRE(n < 200 + limit);
      core.clock();
    }
    core.write(KAGE_REG_IRQ, KAGE_IRQ_WATCHDOG_MASK);
    for (int n = 0; n < 200; ++n) core.clock();
    REQUIRE(core.bites == 1);
    core.in.held = false;
    core.finish();
    REQUIRE(core.bites == 1);
    REQUIRE(core.read(KAGE_REG_ERRORS) == 0);
  });
}

/// Output stands still until units are full and let the stream wait: it is the output that is named, and the tree waits
/// for nobody.
template <class Model>
void full_units_test() {
  static constexpr kage::Config c = config_of<Model>();
  each_seed(10, [&](Dice& dice) {
    Core<Model> core(dice);
    const int limit = dice.between(1, 50);
    core.write(KAGE_REG_WATCHDOG, static_cast<std::uint32_t>(limit));
    core.write(KAGE_REG_CONTROL, KAGE_IRQ_WATCHDOG_MASK);
    core.submit(tree_frame(dice, c, 15, 20, random_order(dice, c.units), 0).words);
    core.out.held = true;
    for (int n = 0; core.bites == 0; ++n) {
      REQUIRE(n < 2000 + limit);
      core.clock();
    }
    REQUIRE(core.beats_left() > 0);
    const std::size_t left = core.beats_left();
    for (int n = 0; n < 200; ++n) core.clock();
    REQUIRE(core.beats_left() == left);
    REQUIRE((core.read(KAGE_REG_STATUS) & (KAGE_STATUS_WAITING_INPUT_MASK | KAGE_STATUS_WAITING_OUTPUT_MASK)) ==
            KAGE_STATUS_WAITING_OUTPUT_MASK);
    REQUIRE((core.read(KAGE_REG_TREE) & KAGE_TREE_BEHIND_MASK) == 0);
    REQUIRE((core.read(KAGE_REG_STALL) & (KAGE_TREE_BEHIND_MASK | KAGE_STALL_ON_INPUT_MASK |
                                          KAGE_STALL_ON_OUTPUT_MASK)) == KAGE_STALL_ON_OUTPUT_MASK);
    REQUIRE(core.bites == 1);
    core.out.held = false;
    core.finish();
    REQUIRE(core.read(KAGE_REG_ERRORS) == 0);
  });
}

}  // namespace

TEST_CASE("With units: reset, a watchdog that never bites a healthy frame, and one that names a standstill",
          "[kage_top_units]") {
  reset_test<Vkage_units5>();
  reset_test<Vkage_units3>();
  reset_within_test<Vkage_units5>();
  reset_within_test<Vkage_units3>();
  healthy_test<Vkage_units5>();
  healthy_test<Vkage_units3>();
  standstill_test<Vkage_units5>();
  standstill_test<Vkage_units3>();
}

TEST_CASE("A line on its way through units and tree is no standstill, however low the watchdog's limit",
          "[kage_top_units]") {
  line_on_its_way_test<Vkage_units5>();
  line_on_its_way_test<Vkage_units3>();
}

TEST_CASE("A unit that is short is named with its line and the TREE", "[kage_top_units]") {
  errors_test<Vkage_units5>(Fault::kShort, kage::ErrorCode::UNIT_SHORT);
  errors_test<Vkage_units3>(Fault::kShort, kage::ErrorCode::UNIT_SHORT);
}

TEST_CASE("A unit with too many pixels, or an empty segment, is named with its line and the SEG", "[kage_top_units]") {
  errors_test<Vkage_units5>(Fault::kLong, kage::ErrorCode::UNIT_LONG);
  errors_test<Vkage_units3>(Fault::kLong, kage::ErrorCode::UNIT_LONG);
  errors_test<Vkage_units5>(Fault::kEmptySegment, kage::ErrorCode::SEGMENT);
  errors_test<Vkage_units3>(Fault::kEmptySegment, kage::ErrorCode::SEGMENT);
}

TEST_CASE("TREE names the lowest unit that is waited for, and the watchdog bites", "[kage_top_units]") {
  waiting_test<Vkage_units5>();
  waiting_test<Vkage_units3>();
}

TEST_CASE("Full units let the stream wait for the output, which is named", "[kage_top_units]") {
  full_units_test<Vkage_units5>();
  full_units_test<Vkage_units3>();
}
