// SPDX-License-Identifier: Apache-2.0
#include "stimulus/polygon_frames.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "number/first_centre.hpp"
#include "polygon/place.hpp"
#include "stimulus/edge_tie.hpp"
#include "stimulus/random_spans.hpp"
#include "stimulus/random_state.hpp"

namespace kage::verif {
namespace {

constexpr int kForever = std::numeric_limits<int>::max();
constexpr int kMostCoordinate = (1 << (kSubpixelBits - 1)) - 1;

/// An AT's fields.
struct Position {
  PolygonToken fields;
  int light = 0;
  [[nodiscard]] Place place() const { return {fields, light}; }
};

/// One side of a polygon that is under way.
struct Side {
  int next = kForever;  // line on which its next edge begins
  int x = 0;            // where it does
  int y = 0;
};

/// A polygon that has begun and has not ended.
struct Alive {
  Position at;
  int end = 0;   // one past its last line
  int last = 0;  // the side whose last edge says that it ends
  std::array<Side, 2> sides;
};

class RandomPolygons {
 public:
  RandomPolygons(Random& random, const Config& c, int width, int height, const PolygonStyle& style, TokenWriter& w,
                 std::array<std::uint64_t, kKinds>& count)
      : random_(&random), c_(c), width_(width), height_(height), style_(style), w_(&w), count_(&count) {}

  void line(int y, int classes) {
    classes_ = classes;
    home_ = style_.spans.port ? random_->in(0, width_ - 1) : 0;
    std::vector<Item> items;
    for (std::size_t i = 0; i < alive_.size(); ++i)
      for (const Side& side : alive_[i].sides)
        if (side.next == y) {
          items.push_back({alive_[i].at, What::edges, i});
          break;
        }
    for (int i = random_->in(0, style_.most_polygons); i > 0; --i) items.push_back({any_place(), What::polygon, 0});
    for (int i = random_->in(0, style_.most_tokens); i > 0; --i) items.push_back({any_place(), What::span, 0});
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.at.place() < b.at.place(); });
    std::vector<Alive> next;
    std::size_t at = 0;  // the first of alive_ whose span front_end has not made
    const auto make_before = [&](Place place) {
      for (; at < alive_.size() && alive_[at].at.place() < place; ++at)
        if (alive_[at].end > y + 1) next.push_back(alive_[at]);
    };
    placed_ = false;
    for (const Item& item : items) {
      const Place place = item.at.place();
      if (item.what == What::polygon) {
        make_before(place);
        // A place is of one polygon, and front_end has room for so many.
        const bool taken = (at < alive_.size() && alive_[at].at.place() == place) ||
                           (!next.empty() && next.back().at.place() == place);
        if (taken || next.size() + alive_.size() - at >= static_cast<std::size_t>(c_.active)) continue;
        go_to(item.at);
        const Alive p = polygon(item.at, y);
        if (p.end > y + 1) next.push_back(p);
      } else if (item.what == What::edges) {
        go_to(item.at);
        edges(alive_[item.polygon], y);
      } else {
        go_to(item.at);
        make_before(place);
        span(item.at);
      }
    }
    for (; at < alive_.size(); ++at)
      if (alive_[at].end > y + 1) next.push_back(alive_[at]);
    alive_ = std::move(next);
  }

 private:
  enum class What { polygon, edges, span };
  struct Item {
    Position at;
    What what;
    std::size_t polygon;  // of edges, in alive_
  };

  void add(Kind k) { ++(*count_)[static_cast<std::size_t>(k)]; }

  /// A number of a place: mostly small, so that places meet; sometimes any.
  int number(int most_small, int bits) {
    return random_->chance(0.9) ? random_->in(0, most_small) : random_->in(0, (1 << bits) - 1);
  }

  Position any_place() {
    Position at;
    std::array<Layer, 3> layers{};
    std::size_t count = 0;
    layers[count++] = Layer::opaque;
    if (c_.dsf_bits > 0) layers[count++] = Layer::volumes;
    if (c_.translucency > 0) layers[count++] = Layer::translucent;
    at.fields.layer = static_cast<int>(layers[static_cast<std::size_t>(random_->in(0, static_cast<int>(count) - 1))]);
    at.fields.sample = number(2, kSampleBits);
    at.fields.volume = number(2, kVolumeBits);
    at.fields.rank = number(40, kRankBits);
    at.light = random_->in(0, derived::place_lights(c_) - 1);
    return at;
  }

  void go_to(const Position& at) {
    if (placed_ && at.place() == place_ && !random_->chance(0.1)) return;
    placed_ = true;
    place_ = at.place();
    w_->at(at.fields, at.light);
    add(Kind::AT);
  }

  /// A plane of values of so many bits, from which fields with `frac` fraction bits are cut. Without `port` no span of
  /// it leaves its accumulator.
  PolygonToken plane(int bits, int frac) {
    PolygonToken t;
    if (style_.spans.port && random_->chance(0.4)) {
      t.value = random_field(*random_, bits);
      t.right = random_field(*random_, bits);
      t.down = random_field(*random_, bits);
      return t;
    }
    const std::int64_t limit = std::int64_t{1} << (bits - 1);
    if (random_->chance(0.2)) {  // level along a span, and anything from line to line
      t.value = random_->chance(0.2) ? (random_->chance(0.5) ? limit - 1 : -limit) : random_field(*random_, bits);
      t.down = random_field(*random_, bits);
      return t;
    }
    t.value = random_->chance(0.5) ? limit / 4 + random_->in(-8, 8) * (std::int64_t{1} << kPlaneFrac)
                                   : random_->integer(-limit / 4, limit / 4 - 1);
    const std::int64_t down = limit / 8 / (height_ + 2);
    t.down = random_->chance(0.3) ? 0 : random_->integer(-down, down);
    // Each pixel's step may be half of its unit off.
    const std::int64_t unit = std::int64_t{1} << (kPlaneFrac - frac);
    const std::int64_t steepest = std::max<std::int64_t>(0, limit / 8 / width_ - unit);
    t.right = random_->chance(0.3) ? 0 : random_->integer(-steepest, steepest);
    return t;
  }

  /// A place across, mostly within the line or near it.
  int across() {
    switch (random_->in(0, 9)) {
      case 0:
        return random_->in(-kMostCoordinate - 1, kMostCoordinate);
      case 1:
        return random_->chance(0.5) ? -kMostCoordinate - 1 : kMostCoordinate;
      case 2:  // past either side
        return std::clamp((random_->chance(0.5) ? -1 : width_ + 1) * 256 + random_->in(-2000, 2000),
                          -kMostCoordinate - 1, kMostCoordinate);
      case 3:  // at the middle of a pixel, or next to it
        return std::min(random_->in(0, width_) * 256 + 128 + random_->in(-1, 1), kMostCoordinate);
      default:
        return std::min(random_->in(-256, width_ * 256 + 256), kMostCoordinate);
    }
  }

  /// A height from which the first line below whose centre is not above it is y.
  int above(int y) { return std::clamp(y * 256 + random_->in(-127, 128), -kMostCoordinate - 1, kMostCoordinate); }

  /// The next edge of a side, on line y.
  PolygonToken edge(Alive& p, int side, int y) {
    Side& s = p.sides[static_cast<std::size_t>(side)];
    PolygonToken t;
    t.side = side;
    t.top_x = s.x;
    t.top_y = s.y;
    const int farthest = std::min(p.end, kMostCoordinate / 256);
    const int bottom =
        random_->chance(0.5) ? farthest : random_->in(y + 1, std::min(farthest, y + 1 + style_.most_lines));
    t.bottom_x = across();
    t.bottom_y = above(bottom);
    if (random_->chance(0.3)) to_tie(t, y, bottom);
    t.last = p.end != kForever && bottom == p.end && (side == p.last || random_->chance(0.5));
    s = {bottom, t.bottom_x, t.bottom_y};
    if (random_->chance(0.05)) s.x = across();  // the outline has a gap
    // An edge that goes on past its end: of no more than 2^16 pixels a line, which is what a step holds.
    const bool flat = std::abs(t.bottom_x - t.top_x) >= (t.bottom_y - t.top_y) * 256.0 * 255;
    if (style_.spans.port && bottom != p.end && !flat && random_->chance(0.2)) s.next += random_->in(1, 3);
    if (!t.last && bottom != p.end && random_->chance(0.1)) s.next = std::max(y + 1, bottom - 1);  // cut short
    if (s.next < bottom) s.y = std::min(s.y, above(s.next));
    if (bottom >= p.end) s.next = kForever;
    // The side that says where the polygon ends must come to say it.
    if (side == p.last && p.end != kForever && s.next >= p.end && s.next != kForever) s.next = p.end - 1;
    if (s.next != kForever && first_centre(s.y) > s.next) s.y = above(s.next);
    return t;
  }

  /// Moves an edge that begins on line y and reaches line `bottom`, across and by a pixel at most, so that the step to
  /// a line between is a tie. It does so if a few slopes near its own have one. The outline then has a gap.
  void to_tie(PolygonToken& t, int y, int bottom) {
    if (bottom < y + 2) return;
    const int line = random_->in(y + 1, std::min(bottom - 1, y + 8));
    constexpr int kSlopes = 16;
    for (int slope = 0; slope < kSlopes; ++slope) {
      PolygonToken moved = t;
      moved.bottom_x += slope;
      // Across by a subpixel is dy of past_centre(); it is a tie if that leaves 1 .. 256.
      const std::int64_t dy = std::int64_t{t.bottom_y} - t.top_y;
      const std::int64_t past = past_centre(moved, line) - 1;
      if (past % dy >= 256) continue;
      const auto back = static_cast<int>(past / dy);
      moved.top_x -= back;
      moved.bottom_x -= back;
      if (moved.top_x < -kMostCoordinate - 1 || moved.bottom_x < -kMostCoordinate - 1 ||
          moved.bottom_x > kMostCoordinate)
        continue;
      t = moved;
      return;
    }
  }

  Alive polygon(const Position& at, int y) {
    Alive p;
    p.at = at;
    const int most = random_->chance(0.2) ? height_ + 3 : style_.most_lines;
    p.end = random_->chance(0.04) ? kForever : random_->chance(0.15) ? y + 1 : y + random_->in(1, std::max(1, most));
    p.last = random_->in(0, 1);
    for (Side& s : p.sides)
      s = {y, across(),
           random_->chance(0.1) ? -kMostCoordinate - 1 : above(y - (random_->chance(0.1) ? random_->in(0, 9) : 0))};
    SpanToken look;
    look.normal_class = random_class(*random_, c_, classes_);
    look.w = c_.dsf_bits > 0 ? random_weight(*random_, c_) : 0;
    look.alpha = c_.translucency == 0 ? 0 : random_->chance(0.3) ? random_->in(0, 1) * 255 : random_->in(0, 255);
    for (std::size_t i = 0; i < static_cast<std::size_t>(c_.channels); ++i) look.color[i] = random_->in(0, 255);
    w_->polygon(plane(kPlaneFrac + c_.z_bits + 2, c_.z_frac), look);
    add(Kind::POLYGON);
    // Both edges and, with SMOOTH, none, some or all of the planes of its colour, before the second edge.
    const int first = random_->in(0, 1);
    gradients();
    begin_edge(p, first, y);
    gradients();
    begin_edge(p, 1 - first, y);
    return p;
  }

  void gradients() {
    if (c_.smooth == 0) return;
    for (int channel = 0; channel < c_.channels; ++channel) {
      if (random_->chance(0.5)) continue;
      PolygonToken t = plane(kColorPlaneBits, c_.color_frac);
      t.channel = channel;
      w_->gradient(t);
      add(Kind::GRADIENT);
    }
  }

  void begin_edge(Alive& p, int side, int y) {
    w_->edge(edge(p, side, y));
    add(Kind::EDGE);
  }

  void edges(Alive& p, int y) {
    const int first = random_->in(0, 1);
    for (const int side : {first, 1 - first})
      if (p.sides[static_cast<std::size_t>(side)].next == y) begin_edge(p, side, y);
  }

  void span(const Position& at) {
    SpanToken s = random_span(*random_, c_, width_, style_.spans, home_, classes_);
    const Layer layer = at.place().is_light(c_) ? Layer::opaque : static_cast<Layer>(at.fields.layer);
    switch (layer) {
      case Layer::opaque:
        w_->op(s);
        add(Kind::OP);
        return;
      case Layer::translucent:
        w_->tp(random_translucent(*random_, c_, width_, style_.spans, home_));
        add(Kind::TP);
        return;
      case Layer::volumes:
        s.w = random_weight(*random_, c_);
        if (random_->chance(0.6)) {
          w_->sp(s);
          add(Kind::SP);
          return;
        }
        if (random_->chance(0.4))
          w_->nc(0, width_, s.w);  // front_end makes IF of it
        else
          w_->nc(s.xl, s.xr, s.w);
        add(Kind::NC);
    }
  }

  Random* random_;
  Config c_;
  int width_;
  int height_;
  PolygonStyle style_;
  TokenWriter* w_;
  std::array<std::uint64_t, kKinds>* count_;
  int classes_ = 0;
  int home_ = 0;
  std::vector<Alive> alive_;  // by place
  bool placed_ = false;       // the line has had an AT
  Place place_;               // of its last
};

}  // namespace

std::array<std::uint64_t, kKinds> random_polygon_frame(Random& random, const Config& c, int width, int height,
                                                       std::vector<std::uint32_t>& words, std::uint32_t number,
                                                       const PolygonStyle& style) {
  width = std::min(width, c.max_width);
  std::array<std::uint64_t, kKinds> count{};
  TokenWriter w(c, words);
  w.header({.width = width,
            .height = height,
            .background = static_cast<std::uint32_t>(random.in(0, 0xFFFFFF)),
            .frame = number,
            .version = kPolygonVersion});
  RandomState state(random, c, width, height, style.spans, w, count);
  RandomPolygons polygons(random, c, width, height, style, w, count);
  for (int y = 0; y < height; ++y) {
    state.begin_line(y);
    polygons.line(y, state.classes());
    w.eol(y);
    ++count[static_cast<std::size_t>(Kind::EOL)];
  }
  w.end();
  ++count[static_cast<std::size_t>(Kind::END)];
  return count;
}

}  // namespace kage::verif
