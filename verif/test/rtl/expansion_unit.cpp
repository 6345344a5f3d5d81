// SPDX-License-Identifier: Apache-2.0
// expansion_unit: pixels of random lines under any stalls, over frames with faces of their own and flushes at any
// clock; how much it buffers; its latency.
#include <deque>
#include <optional>

#include "Vunit.h"
#include "Vunit_classic.h"
#include "tree_model.hpp"

using namespace kage::rtl;

namespace {

constexpr TreeShape kShape = tree_shape_of<Vunit>();

template <class Top>
Point point_of(Top& top, const TreeShape& s) {
  const int paint = s.lit_bits() + s.rgb_bits();
  return {get(top.px_data_o, paint + s.order_bits, s.z_bits), get(top.px_data_o, paint, s.order_bits),
          get(top.px_data_o, s.lit_bits(), s.rgb_bits()), s.lit_bits() != 0 ? get(top.px_data_o, 0, 1) : 0,
          top.px_last_o != 0};
}

template <class Top>
void quiet(Top& top, int width) {
  top.frame_start_i = 0;
  top.flush_i = 0;
  top.width_i = static_cast<SData>(width);
  top.face_valid_i = 0;
  top.seg_valid_i = 0;
  top.px_ready_i = 0;
}

template <class Model>
void random_test() {
  constexpr TreeShape s = tree_shape_of<Model>();
  each_seed(25, [&](Dice& dice) {
    Bench<Model> top(dice);
    const bool flushes = dice.percent(40);
    const int face_stall = stall_percent(dice), out_stall = stall_percent(dice);
    Offer offer(stall_percent(dice));
    int width = 1, frames = 0, lines = 0, in_first = 0, flushed = 0, shared = 0;
    std::vector<Face> faces;
    std::size_t defined = 0;
    std::deque<std::vector<Segment>> to_give;
    std::deque<Segment> giving;  // of the line that comes in
    std::vector<Segment> line;   // the whole of it
    std::deque<Point> expected;  // of lines that came in whole
    std::size_t older = 0;       // pixels of them that belong to the frame before
    std::optional<Point> waiting;
    bool mid_line = false;
    quiet(*top, width);
    while (frames < 12 || !to_give.empty() || !giving.empty() || !expected.empty()) {
      REQUIRE(top.clocks < 400000);
      quiet(*top, width);
      const bool flush = flushes && dice.below(400) == 0;
      const bool frame_over = to_give.empty() && giving.empty();
      const bool start = !flush && frames < 12 && frame_over && older == 0 && dice.percent(50);
      top->flush_i = flush ? 1 : 0;
      top->frame_start_i = start ? 1 : 0;
      const bool define = !frame_over && defined < faces.size() && !dice.percent(face_stall);
      if (define) {
        top->face_valid_i = 1;
        put_face(*top, s, static_cast<int>(defined), faces[defined]);
      }
      if (giving.empty() && !to_give.empty()) {
        line = to_give.front();
        giving.assign(line.begin(), line.end());
        to_give.pop_front();
      }
      const bool can_give = defined == faces.size() && !giving.empty();
      if (offer(dice, can_give)) {
        top->seg_valid_i = 1;
        put_segment(*top, s, giving.front());
      }
      top->px_ready_i = dice.percent(out_stall) ? 0 : 1;
      top.settle();

      // Lines inside that have not left whole: with less than two there is a free half.
      const auto inside = std::count_if(expected.begin(), expected.end(), [](const Point& p) { return p.last; });
      if (inside < 2) REQUIRE(top->seg_ready_o);
      if (mid_line) REQUIRE(top->px_valid_o);  // no bubble
      if (top->px_valid_o) {
        REQUIRE(!expected.empty());
        REQUIRE(point_of(*top, s) == expected.front());
      }
      if (waiting) {
        REQUIRE(top->px_valid_o);
        REQUIRE(point_of(*top, s) == *waiting);
      }
      const bool out = top->px_valid_o && top->px_ready_i;
      const bool in = top->seg_valid_i && top->seg_ready_o;
      waiting = top->px_valid_o && !out && !flush ? std::optional(point_of(*top, s)) : std::nullopt;
      top.edge();

      if (out) {
        mid_line = !expected.front().last;
        expected.pop_front();
        if (older > 0) --older;
        ++in_first;
      }
      if (in) {
        offer.taken();
        giving.pop_front();
        if (giving.empty()) {
          const auto points = expand(s, faces, line);
          expected.insert(expected.end(), points.begin(), points.end());
          ++lines;
        }
      }
      if (define) {
        ++defined;
        if (older > 0) ++shared;  // both banks are in use
      }
      if (start) {
        older = expected.size();
        width = dice.percent(10) ? s.widest() : dice.percent(20) ? dice.between(1, 3) : dice.between(1, s.widest());
        if (s.classic != 0 && dice.percent(70)) width = std::min(width, 40);
        faces.resize(static_cast<std::size_t>(dice.percent(20) ? s.blank() : dice.below(std::min(s.blank(), 9))));
        for (Face& face : faces) face = random_face(dice, s);
        defined = 0;
        for (int i = dice.between(0, 5); i > 0; --i)
          to_give.push_back(random_line(dice, s, width, static_cast<int>(faces.size())));
        ++frames;
      }
      if (flush) {
        expected.clear();
        to_give.clear();
        giving.clear();
        offer.taken();
        older = 0;
        mid_line = false;
        ++flushed;
      }
    }
    REQUIRE(frames == 12);
  });
}

}  // namespace

TEST_CASE("expansion_unit makes the pixels of its segments", "[expansion_unit]") { random_test<Vunit>(); }
TEST_CASE("expansion_unit makes the pixels of the paper's segments", "[expansion_unit]") {
  random_test<Vunit_classic>();
}

TEST_CASE("expansion_unit buffers two lines of 2^SEG_BITS segments and no more", "[expansion_unit]") {
  each_seed(3, [](Dice& dice) {
    Bench<Vunit> top(dice);
    const int width = dice.between(8, 16);
    std::vector<Point> expected;
    std::deque<Segment> segments;
    for (int i = 0; i < 3; ++i) {
      std::vector<Segment> line(8, Segment{0, 1, kShape.blank()});  // eight segments, the last one as long as is left
      line.back().dx = width - 7;
      segments.insert(segments.end(), line.begin(), line.end());
      const auto points = expand(kShape, {}, line);
      expected.insert(expected.end(), points.begin(), points.end());
    }
    std::size_t given = 0, taken = 0;
    for (int clock = 0; clock < 200; ++clock) {
      quiet(*top, width);
      top->px_ready_i = clock >= 100 ? 1 : 0;
      top->seg_valid_i = given < segments.size() ? 1 : 0;
      if (given < segments.size()) put_segment(*top, kShape, segments[given]);
      top.settle();
      if (clock < 100 && given < 16) REQUIRE(top->seg_ready_o);
      if (clock < 100 && given == 16) REQUIRE(!top->seg_ready_o);
      if (top->px_valid_o && top->px_ready_i) {
        REQUIRE(taken < expected.size());
        REQUIRE(point_of(*top, kShape) == expected[taken++]);
      }
      if (top->seg_valid_i && top->seg_ready_o) ++given;
      top.edge();
    }
    REQUIRE(given == 24);
    REQUIRE(taken == expected.size());
  });
}

TEST_CASE("expansion_unit takes 6 clocks to a line's first pixel and leaves no gap between lines", "[expansion_unit]") {
  each_seed(5, [](Dice& dice) {
    Bench<Vunit> top(dice);
    const int width = dice.between(1, 8);
    const int lines = 6;
    std::uint64_t complete = 0, first = 0, last = 0;
    int given = 0, taken = 0;
    while (taken < width * lines) {
      REQUIRE(top.clocks < 1000);
      quiet(*top, width);
      top->px_ready_i = 1;
      top->seg_valid_i = given < width * lines ? 1 : 0;
      put_segment(*top, kShape, {0, 1, kShape.blank()});
      top.settle();
      if (top->px_valid_o) {
        if (taken == 0) first = top.clocks;
        last = top.clocks;
        ++taken;
      }
      if (top->seg_valid_i && top->seg_ready_o && ++given == width) complete = top.clocks;
      top.edge();
    }
    REQUIRE(first - complete == 6);
    REQUIRE(last - first == static_cast<std::uint64_t>(width * lines - 1));
  });
}
