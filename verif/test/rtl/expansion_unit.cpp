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
void quiet(Top& top) {
  top.frame_start_i = 0;
  top.flush_i = 0;
  top.face_valid_i = 0;
  top.seg_valid_i = 0;
  top.px_ready_i = 0;
}

/// Random frames go in, with faces of their own, and are flushed now and then; the pixels of lines that came in whole
/// come out.
template <class Model>
class Frames {
 public:
  explicit Frames(Dice& dice)
      : dice_(dice),
        top_(dice),
        flushes_(dice.percent(40)),
        face_stall_(stall_percent(dice)),
        out_stall_(stall_percent(dice)),
        offer_(stall_percent(dice)) {}

  void run() {
    quiet(*top_);
    while (frames_ < kFrames || !to_give_.empty() || !giving_.empty() || !expected_.empty()) {
      REQUIRE(top_.clocks < 400000);
      quiet(*top_);
      offer();
      look();
      edge();
    }
    REQUIRE(frames_ == kFrames);
  }

 private:
  static constexpr TreeShape kOf = tree_shape_of<Model>();
  static constexpr int kFrames = 12;

  /// Offers the input of this clock: a flush, the begin of a frame, a face, a segment.
  void offer() {
    flush_ = flushes_ && dice_.below(400) == 0;
    const bool frame_over = to_give_.empty() && giving_.empty();
    start_ = !flush_ && frames_ < kFrames && frame_over && older_ == 0 && dice_.percent(50);
    top_->flush_i = flush_ ? 1 : 0;
    top_->frame_start_i = start_ ? 1 : 0;
    define_ = !frame_over && defined_ < faces_.size() && !dice_.percent(face_stall_);
    if (define_) {
      top_->face_valid_i = 1;
      put_face(*top_, kOf, static_cast<int>(defined_), faces_[defined_]);
    }
    if (giving_.empty() && !to_give_.empty()) {
      line_ = to_give_.front();
      giving_.assign(line_.begin(), line_.end());
      to_give_.pop_front();
    }
    if (offer_(dice_, defined_ == faces_.size() && !giving_.empty())) {
      top_->seg_valid_i = 1;
      put_segment(*top_, kOf, giving_.front());
    }
    top_->px_ready_i = dice_.percent(out_stall_) ? 0 : 1;
    top_.settle();
  }

  void look() {
    // Lines inside that have not left whole: with less than two there is a free half.
    const auto inside = std::count_if(expected_.begin(), expected_.end(), [](const Point& p) { return p.last; });
    if (inside < 2) REQUIRE(top_->seg_ready_o);
    if (mid_line_) REQUIRE(top_->px_valid_o);  // no bubble
    if (top_->px_valid_o) {
      REQUIRE(!expected_.empty());
      REQUIRE(point_of(*top_, kOf) == expected_.front());
    }
    if (waiting_) {
      REQUIRE(top_->px_valid_o);
      REQUIRE(point_of(*top_, kOf) == *waiting_);
    }
  }

  void edge() {
    const bool out = top_->px_valid_o && top_->px_ready_i;
    const bool in = top_->seg_valid_i && top_->seg_ready_o;
    waiting_ = top_->px_valid_o && !out && !flush_ ? std::optional(point_of(*top_, kOf)) : std::nullopt;
    top_.edge();
    if (out) {
      mid_line_ = !expected_.front().last;
      expected_.pop_front();
      if (older_ > 0) --older_;
    }
    if (in) {
      offer_.taken();
      giving_.pop_front();
      if (giving_.empty()) {
        const auto points = expand(kOf, faces_, line_);
        expected_.insert(expected_.end(), points.begin(), points.end());
      }
    }
    if (define_) ++defined_;
    if (start_) begin_frame();
    if (flush_) flush();
  }

  void begin_frame() {
    older_ = expected_.size();
    const int widest = kOf.widest();
    width_ = dice_.percent(10) ? widest : dice_.percent(20) ? dice_.between(1, 3) : dice_.between(1, widest);
    if (kOf.classic != 0 && dice_.percent(70)) width_ = std::min(width_, 40);
    const int blank = kOf.blank();
    faces_.resize(static_cast<std::size_t>(dice_.percent(20) ? blank : dice_.below(std::min(blank, 9))));
    for (Face& face : faces_) face = random_face(dice_, kOf);
    defined_ = 0;
    for (int i = dice_.between(0, 5); i > 0; --i)
      to_give_.push_back(random_line(dice_, kOf, width_, static_cast<int>(faces_.size())));
    ++frames_;
  }

  void flush() {
    expected_.clear();
    to_give_.clear();
    giving_.clear();
    offer_.taken();
    older_ = 0;
    mid_line_ = false;
  }

  Dice& dice_;
  Bench<Model> top_;
  bool flushes_;
  int face_stall_, out_stall_;
  Offer offer_;
  int width_ = 1, frames_ = 0;
  std::vector<Face> faces_;
  std::size_t defined_ = 0;  // of them
  std::deque<std::vector<Segment>> to_give_;
  std::deque<Segment> giving_;  // of the line that comes in
  std::vector<Segment> line_;   // the whole of it
  std::deque<Point> expected_;  // of lines that came in whole
  std::size_t older_ = 0;       // pixels of them that belong to the frame before
  std::optional<Point> waiting_;
  bool mid_line_ = false;
  bool flush_ = false, start_ = false, define_ = false;  // this clock
};

template <class Model>
void random_test() {
  each_seed(25, [](Dice& dice) { Frames<Model>(dice).run(); });
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
      std::vector<Segment> line(
          8, Segment{0, 1, kShape.blank(), false});  // eight segments, the last one as long as is left
      line.back().dx = width - 7;
      line.back().completes = true;
      segments.insert(segments.end(), line.begin(), line.end());
      const auto points = expand(kShape, {}, line);
      expected.insert(expected.end(), points.begin(), points.end());
    }
    std::size_t given = 0, taken = 0;
    for (int clock = 0; clock < 200; ++clock) {
      quiet(*top);
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
      quiet(*top);
      top->px_ready_i = 1;
      top->seg_valid_i = given < width * lines ? 1 : 0;
      put_segment(*top, kShape, {0, 1, kShape.blank(), given % width == width - 1});
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
