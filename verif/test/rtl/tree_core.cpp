// SPDX-License-Identifier: Apache-2.0
// tree_core: lines of random frames under any stalls, frames in close succession and flushes at any clock; the clocks
// of a line; whom the tree waits for.
#include <deque>
#include <optional>

#include "Vcore1.h"
#include "Vcore16.h"
#include "Vcore2.h"
#include "Vcore3.h"
#include "Vcore32.h"
#include "Vcore4.h"
#include "Vcore5.h"
#include "Vcore64.h"
#include "Vcore8.h"
#include "tree_model.hpp"

using namespace kage::rtl;

namespace {

constexpr TreeCallBus kCall(kage::Config{});

struct Pixel {
  std::uint64_t z, color, lit;
  bool last;
  bool operator==(const Pixel&) const = default;
};

template <class Top>
Pixel pixel_of(const Top& top, const TreeShape& s) {
  const TreePixelBus pixel(s);
  return {get(top.line_o, pixel.z), get(top.line_o, pixel.color), get(top.line_o, pixel.normal_class),
          get(top.line_o, pixel.last) != 0};
}

template <class Top>
void put_unit(Top& top, const TreeShape& s, int unit) {
  put(top.piece_i, PieceBus(s).unit, static_cast<std::uint64_t>(unit));
}

using Lines = std::vector<std::vector<Point>>;  // of each unit

std::vector<Pixel> merge(const Lines& units) {
  std::vector<Pixel> line;
  for (std::size_t x = 0; x < units[0].size(); ++x) {
    const Point* best = &units[0][x];
    for (const auto& unit : units)
      if (unit[x].z < best->z || (unit[x].z == best->z && unit[x].index < best->index)) best = &unit[x];
    line.push_back({best->z, best->color, best->lit, best->last});
  }
  return line;
}

template <class Top>
void quiet(Top& top) {
  put(top.call_i, kCall.start, 0);
  put(top.call_i, kCall.flush, 0);
  put(top.call_i, kCall.claim, 0);
  put(top.call_i, kCall.face, 0);
  top.seg_valid_i = 0;
  top.line_ready_i = 0;
}

/// An event of a frame; they come in order: faces, segments, and TREE's claims.
struct Event {
  enum Kind { kFace, kSegment, kClaim } kind;
  int unit, number;
  Face face;
  Segment segment;
  std::vector<Pixel> line;  // of the claim
};

std::deque<Event> random_frame(Dice& dice, const TreeShape& s, int width) {
  const auto n = static_cast<std::size_t>(s.units);
  std::deque<Event> events;
  std::vector<std::vector<Face>> faces(n);
  std::vector<std::size_t> order;
  for (std::size_t u = 0; u < n; ++u) {
    faces[u].resize(static_cast<std::size_t>(dice.below(5)));
    order.insert(order.end(), faces[u].size(), u);
  }
  std::vector<int> defined(n);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(dice.below(static_cast<int>(i)))]);
  for (const std::size_t u : order) {
    Face& face = faces[u][static_cast<std::size_t>(defined[u])];
    face = random_face(dice, s);
    events.push_back({Event::kFace, static_cast<int>(u), defined[u]++, face, {}, {}});
  }
  const auto lines = static_cast<std::size_t>(dice.between(0, 5));
  std::vector<std::deque<std::pair<std::size_t, Segment>>> waiting(n);  // with the line it belongs to
  std::vector<Lines> points(lines, Lines(n));
  for (std::size_t u = 0; u < n; ++u) {
    for (std::size_t y = 0; y < lines; ++y) {
      const auto line = random_line(dice, s, width, static_cast<int>(faces[u].size()));
      points[y][u] = expand(s, faces[u], line);
      for (const Segment& segment : line) waiting[u].emplace_back(y, segment);
    }
  }
  for (std::size_t y = 0; y < lines; ++y) {
    const int eager = dice.below(100);  // how much of the next line comes before this line's TREE
    for (;;) {
      std::vector<std::size_t> due, next;
      for (std::size_t u = 0; u < n; ++u) {
        if (waiting[u].empty()) continue;
        if (waiting[u].front().first == y) due.push_back(u);
        if (waiting[u].front().first == y + 1) next.push_back(u);
      }
      if (due.empty() && (next.empty() || !dice.percent(eager))) break;
      const bool ahead = due.empty() || (!next.empty() && dice.percent(eager));
      const auto& from = ahead ? next : due;
      const std::size_t u = from[static_cast<std::size_t>(dice.below(static_cast<int>(from.size())))];
      events.push_back({Event::kSegment, static_cast<int>(u), 0, {}, waiting[u].front().second, {}});
      waiting[u].pop_front();
    }
    events.push_back({Event::kClaim, 0, 0, {}, {}, merge(points[y])});
  }
  return events;
}

/// Frames in close succession, flushed now and then: what was claimed comes out.
template <class Model>
class Frames {
 public:
  explicit Frames(Dice& dice)
      : dice_(dice),
        top_(dice),
        flushes_(dice.percent(50)),
        out_stall_(stall_percent(dice)),
        offer_(stall_percent(dice)) {}

  void run() {
    while (frames_ < kFrames || !events_.empty() || !expected_.empty()) {
      REQUIRE(top_.clocks < 400000);
      quiet(*top_);
      begin();
      if (!flush_ && open_ && offer_(dice_, !events_.empty()))
        bring(events_.front());
      else
        event_ = nullptr;
      // The reader takes what has been claimed in an earlier clock.
      top_->line_ready_i = !expected_.empty() && !dice_.percent(out_stall_) ? 1 : 0;
      top_.settle();
      look();
      edge();
    }
  }

 private:
  static constexpr TreeShape kOf = tree_shape_of<Model>();
  static constexpr int kFrames = 14;

  /// A flush, or the begin of a frame, which may be as soon as all lines of the frame before the last one have left,
  /// and comes two clocks or more behind what ends frame_ready_o.
  void begin() {
    flush_ = flushes_ && open_ && dice_.below(150) == 0;
    put(top_->call_i, kCall.flush, flush_ ? 1 : 0);
    if (open_ && events_.empty() && !flush_) open_ = false;
    const bool wanted = !open_ && !flush_ && frames_ < kFrames && top_.clocks >= settled_ && dice_.percent(60);
    top_.settle();
    start_ = wanted && top_->frame_ready_o;
    put(top_->call_i, kCall.start, start_ ? 1 : 0);
  }

  void bring(const Event& event) {
    event_ = &event;
    if (event.kind == Event::kFace) {
      put(top_->call_i, kCall.face, 1);
      put_unit(*top_, kOf, event.unit);
      put_face(*top_, kOf, event.number, event.face);
    } else if (event.kind == Event::kSegment) {
      top_->seg_valid_i = 1;
      put_unit(*top_, kOf, event.unit);
      put_segment(*top_, kOf, event.segment);
    } else {
      put(top_->call_i, kCall.claim, 1);
    }
  }

  void look() {
    if (top_->line_valid_o && !expected_.empty()) REQUIRE(pixel_of(*top_, kOf) == expected_.front());
    if (waiting_) {
      REQUIRE(top_->line_valid_o);
      REQUIRE(pixel_of(*top_, kOf) == *waiting_);
    }
  }

  void edge() {
    const bool out = top_->line_valid_o && top_->line_ready_i;
    const bool hold = top_->line_valid_o && !out && !expected_.empty();
    waiting_ = hold ? std::optional(pixel_of(*top_, kOf)) : std::nullopt;
    const bool segment = event_ != nullptr && event_->kind == Event::kSegment;
    const bool done = event_ != nullptr && (!segment || top_->seg_ready_o);
    top_.edge();
    if (out) {
      if (expected_.front().last) ++left_;
      expected_.pop_front();
    }
    if (done) {
      if (event_->kind == Event::kClaim) {
        expected_.insert(expected_.end(), event_->line.begin(), event_->line.end());
        ++claimed_;
      }
      events_.pop_front();
      offer_.taken();
    }
    if (flush_) {
      events_.clear();
      offer_.taken();
      open_ = false;
    }
    if (start_) begin_frame();
    if (start_ || flush_ || (segment && done)) settled_ = top_.clocks + 1;
  }

  void begin_frame() {
    if (!last_line_.empty()) REQUIRE(left_ >= last_line_.back());  // of the frame before the last one none is left
    last_line_.push_back(claimed_);
    const int widest = kOf.widest();
    width_ = dice_.percent(15) ? widest : dice_.percent(40) ? dice_.between(1, 3) : dice_.between(1, widest);
    if (widest > 100 && dice_.percent(80)) width_ = std::min(width_, 30);
    events_ = random_frame(dice_, kOf, width_);
    open_ = true;
    ++frames_;
  }

  Dice& dice_;
  Bench<Model> top_;
  bool flushes_;
  int out_stall_;
  Offer offer_;
  std::deque<Event> events_;
  std::deque<Pixel> expected_;  // of lines claimed
  std::optional<Pixel> waiting_;
  int width_ = 1, frames_ = 0, claimed_ = 0, left_ = 0;
  std::uint64_t settled_ = 0;           // the clock from which on frame_ready_o says all that has been
  bool open_ = false;                   // a frame has begun and has not been flushed
  std::vector<int> last_line_;          // claims up to the end of each frame
  bool flush_ = false, start_ = false;  // this clock
  const Event* event_ = nullptr;        // of this clock
};

template <class Model>
void random_test(int seeds = 25) {
  each_seed(seeds, [](Dice& dice) { Frames<Model>(dice).run(); });
}

template <class Model>
void clocks_test() {
  constexpr TreeShape s = tree_shape_of<Model>();
  constexpr int units = s.units;
  int levels = 0;
  while (1 << levels < units) ++levels;
  const int buffers = levels > 0 ? (levels - 1) / 2 : 0;
  each_seed(3, [&](Dice& dice) {
    Bench<Model> top(dice);
    const int width = dice.between(1, 8);  // segments of length 1: no other could show a bubble
    std::uint64_t complete = 0, first = 0;
    int given = 0, taken = 0;
    // The first line: given unit by unit, so that one comes last; then no stall until it has left.
    while (taken < width) {
      REQUIRE(top.clocks < 5000);
      quiet(*top);
      top->line_ready_i = 1;
      top->seg_valid_i = given < width * units ? 1 : 0;
      put_unit(*top, s, given / width);
      put_segment(*top, s, {0, 1, s.blank(), given % width == width - 1});
      put(top->call_i, kCall.claim, top.clocks == complete + 1 && complete != 0 ? 1 : 0);
      top.settle();
      if (top->line_valid_o) {
        if (taken == 0) first = top.clocks;
        REQUIRE(top.clocks == first + static_cast<std::uint64_t>(taken));  // no bubble
        REQUIRE(pixel_of(*top, s).last == (taken == width - 1));
        ++taken;
      }
      if (top->seg_valid_i && top->seg_ready_o && ++given == width * units) complete = top.clocks;
      top.edge();
    }
    // From the segment that completes the line to the line's last pixel: the latency, and a clock for each further
    // pixel.
    REQUIRE(first - complete == static_cast<std::uint64_t>(7 + levels + buffers));
    REQUIRE(top.clocks - complete == static_cast<std::uint64_t>(7 + levels + buffers + width));
  });
}

template <class Model>
void two_lines_test() {
  constexpr TreeShape s = tree_shape_of<Model>();
  constexpr int units = s.units;
  each_seed(2, [&](Dice& dice) {
    Bench<Model> top(dice);
    const int width = 8;
    int given = 0, taken = 0;
    for (int clock = 0; clock < 40 * units + 100; ++clock) {
      quiet(*top);
      top->seg_valid_i = given < 2 * width * units ? 1 : 0;
      put_unit(*top, s, given / width % units);
      put_segment(*top, s, {0, 1, s.blank(), given % width == width - 1});
      put(top->call_i, kCall.claim, clock == 40 * units || clock == 40 * units + 1 ? 1 : 0);
      top->line_ready_i = clock >= 40 * units + 1 ? 1 : 0;
      top.settle();
      if (top->line_ready_i && taken < 2 * width) {
        REQUIRE(top->line_valid_o);  // two lines without a gap
        ++taken;
      }
      if (top->seg_valid_i && top->seg_ready_o) ++given;
      top.edge();
    }
    REQUIRE(taken == 2 * width);
    REQUIRE(!top->line_valid_o);
  });
}

}  // namespace

TEST_CASE("tree_core of 1 unit", "[tree_core]") { random_test<Vcore1>(); }
TEST_CASE("tree_core of 2 units", "[tree_core]") { random_test<Vcore2>(); }
TEST_CASE("tree_core of 3 units, the paper's segments", "[tree_core]") { random_test<Vcore3>(); }
TEST_CASE("tree_core of 5 units", "[tree_core]") { random_test<Vcore5>(); }
TEST_CASE("tree_core of 8 units", "[tree_core]") { random_test<Vcore8>(); }
TEST_CASE("tree_core of 64 units", "[tree_core]") { random_test<Vcore64>(3); }

TEST_CASE("tree_core takes a line's width and its latency", "[tree_core]") {
  clocks_test<Vcore1>();
  clocks_test<Vcore2>();
  clocks_test<Vcore4>();
  clocks_test<Vcore5>();
  clocks_test<Vcore8>();
  clocks_test<Vcore16>();
  clocks_test<Vcore32>();
  clocks_test<Vcore64>();
}

TEST_CASE("tree_core sends buffered lines without a gap", "[tree_core]") {
  two_lines_test<Vcore1>();
  two_lines_test<Vcore5>();
  two_lines_test<Vcore64>();
}

TEST_CASE("tree_core drops by a flush what was not claimed, and holds the next frame until then", "[tree_core]") {
  each_seed(10, [](Dice& dice) {
    constexpr TreeShape kTwo = tree_shape_of<Vcore2>();
    Bench<Vcore2> top(dice);
    const int width = dice.between(1, 8);
    const int claims = dice.below(3);
    int given = 0, taken = 0;
    const auto clock = [&](bool flush, bool claim, bool ready) {
      quiet(*top);
      top->seg_valid_i = !flush && given < 4 ? 1 : 0;
      put_unit(*top, kTwo, given % 2);
      put_segment(*top, kTwo, {0, width, kTwo.blank(), true});
      put(top->call_i, kCall.flush, flush ? 1 : 0);
      put(top->call_i, kCall.claim, claim ? 1 : 0);
      top->line_ready_i = ready ? 1 : 0;
      top.settle();
      if (top->seg_valid_i && top->seg_ready_o) ++given;
      if (top->line_valid_o && ready) ++taken;
      top.edge();
    };
    for (int i = 0; i < 20; ++i) clock(false, false, false);
    REQUIRE(given == 4);
    for (int i = 0; i < claims; ++i) clock(false, true, false);
    clock(true, false, false);
    for (int i = 0; i < 10; ++i) {
      top.settle();
      REQUIRE(top->frame_ready_o == (i == 0 || (claims == 0 && i > 1) ? 1 : 0));
      clock(false, false, false);
    }
    while (taken < claims * width) {
      REQUIRE(top.clocks < 500);
      REQUIRE(!top->frame_ready_o);
      clock(false, false, true);
    }
    for (int i = 0; i < 3; ++i) clock(false, false, false);
    REQUIRE(top->frame_ready_o);
    for (int i = 0; i < 20; ++i) {
      REQUIRE(!top->line_valid_o);
      clock(false, false, false);
    }
  });
}
