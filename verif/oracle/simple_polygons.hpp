// SPDX-License-Identifier: Apache-2.0
//
// The polygon level of docs/stream.md as plainly as it can be written: nothing goes from line to line but what the
// tokens said. On each line edges are exact fractions, planes are multiplied out, and polygons are sorted.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "kage/defs.hpp"
#include "number/int128.hpp"

namespace kage::verif {

/// A span that the front end makes, or an end of spans.
struct PlainSpan {
  Kind kind{};
  std::int64_t xl = 0, xr = 0, w = 0, z = 0, dz = 0, normal_class = 0, alpha = 0, light = 0, samples = 0;
  std::array<std::int64_t, 3> color{}, dcolor{};
};

class SimplePolygons {
 public:
  /// The value of a field of the token at hand.
  using Fields = std::function<std::int64_t(Field)>;
  /// Takes what is made; false if there is something wrong with it, and no more is to come.
  using Make = std::function<bool(const PlainSpan&)>;

  SimplePolygons(const Config& c, std::int64_t width) : c_(c), l_(c), width_(width) {}

  /// The next step with a token.
  enum class Verdict {
    done,     ///< nothing more
    itself,   ///< it is a token of the span level, whose turn it is now
    stopped,  ///< what was made of it is wrong
    place,    ///< error PLACE
    full      ///< error ACTIVE_FULL
  };

  Verdict take(Kind kind, const Fields& field, const Make& make) {
    const bool of_polygon = kind == Kind::EDGE || kind == Kind::GRADIENT;
    if (waits_ && !of_polygon) return Verdict::place;
    switch (kind) {
      case Kind::AT: {
        const Place to{field(l_.at_layer), field(l_.at_sample), field(l_.at_light), field(l_.at_volume),
                       field(l_.at_rank)};
        const int lights = c_.linear_bits > 0 ? 2 : c_.lights;  // 1: spans that bring a light
        const bool layer =
            to[0] == 0 || (to[0] == 1 && c_.dsf_bits > 0 && to[2] < lights) || (to[0] == 2 && c_.translucency > 0);
        if (!layer || (!place_.empty() && to < place_.back())) return Verdict::place;
        place_.push_back(to);
        return Verdict::done;
      }
      case Kind::POLYGON:
        if (place_.empty()) return Verdict::place;
        if (!before(place_.back(), make, true)) return Verdict::stopped;
        begin(field);
        return Verdict::done;
      case Kind::GRADIENT: {
        const std::int64_t channel = field(l_.gradient_channel);
        if (!waits_ || channel >= c_.channels) return Verdict::place;
        fresh_.color[static_cast<std::size_t>(channel)] = {field(l_.gradient_value), field(l_.gradient_right),
                                                           field(l_.gradient_down)};
        return Verdict::done;
      }
      case Kind::EDGE:
        return edge(field, make);
      case Kind::OP:
        return span(kind, 0, 0, 0, make);
      case Kind::TP:
        return span(kind, 2, 0, 0, make);
      case Kind::SP:
        return span(kind, 1, field(l_.sp_xl), field(l_.sp_xr), make);
      case Kind::NC:
        return near_cap(field, make);
      case Kind::EOL:
        return end_line(make);
      default:
        return Verdict::itself;
    }
  }

  /// Whether an edge did not go down through its line's centre, or went on past its end by 2^16 pixels a line or more:
  /// the contract leaves open what its polygon's spans are.
  [[nodiscard]] bool loose() const { return loose_; }

 private:
  /// Layer, sample, light, volume, rank: compared in this order.
  using Place = std::array<std::int64_t, 5>;

  struct Plane {
    std::int64_t value = 0, right = 0, down = 0;
  };
  struct Edge {
    bool there = false;
    std::int64_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  };
  struct Polygon {
    Place place{};
    std::int64_t first = 0;     // its first line
    std::int64_t end = 0xFFFF;  // one past its last
    std::array<Edge, 2> edges;
    Plane depth;
    std::array<Plane, 3> color;
    std::int64_t w = 0, normal_class = 0, alpha = 0;
    bool made = false;  // its span on this line
  };
  struct Run {
    std::int64_t xl, xr;
  };

  static std::int64_t wrap(Int128 v, int bits) {
    const Int128 modulus = static_cast<Int128>(1) << bits;
    Int128 r = v % modulus;
    if (r < 0) r += modulus;
    return static_cast<std::int64_t>(r >= modulus / 2 ? r - modulus : r);
  }

  static Int128 floor_of(Int128 n, Int128 d) { return n >= 0 ? n / d : -((-n + d - 1) / d); }
  static Int128 ceiling_of(Int128 n, Int128 d) { return -floor_of(-n, d); }

  void begin(const Fields& field) {
    waits_ = true;
    fresh_ = {};
    fresh_.place = place_.back();
    fresh_.first = line_;
    fresh_.depth = {field(l_.polygon_value), field(l_.polygon_right), field(l_.polygon_down)};
    fresh_.w = field(l_.polygon_w);
    fresh_.normal_class = field(l_.polygon_class);
    fresh_.alpha = field(l_.polygon_alpha);
    for (std::size_t i = 0; i < static_cast<std::size_t>(c_.channels); ++i)
      fresh_.color[i].value = field(l_.polygon_color[i]) * (std::int64_t{1} << 24);
  }

  Verdict edge(const Fields& field, const Make& make) {
    Polygon* of = &fresh_;
    if (!waits_) {
      if (place_.empty()) return Verdict::place;
      if (!before(place_.back(), make)) return Verdict::stopped;
      const std::vector<Polygon*> here = in_order([&](const Polygon& p) { return p.place == place_.back(); });
      if (here.empty()) return Verdict::place;
      of = here.front();
    }
    Edge& e = of->edges[static_cast<std::size_t>(field(l_.edge_side))];
    e = {true, field(l_.edge_top_x), field(l_.edge_top_y), field(l_.edge_bottom_x), field(l_.edge_bottom_y)};
    loose_ = loose_ || e.y0 >= e.y1 || first_below(e.y0) > line_ || first_below(e.y1) <= line_;
    // It ends before the first line whose centre is not above the edge's lower end.
    if (field(l_.edge_last) != 0) of->end = first_below(e.y1);
    if (!waits_ || !fresh_.edges[0].there || !fresh_.edges[1].there) return Verdict::done;
    std::int64_t active = 0;
    for (const Polygon& p : polygons_) active += !p.made || p.end > line_ + 1 ? 1 : 0;
    if (active >= c_.active) return Verdict::full;
    waits_ = false;
    polygons_.push_back(fresh_);
    return made(polygons_.back(), make) ? Verdict::done : Verdict::stopped;
  }

  [[nodiscard]] bool brings_light(const Place& place) const {
    return c_.linear_bits > 0 && place[0] == 1 && place[2] == 1;
  }

  Verdict span(Kind kind, std::int64_t layer, std::int64_t xl, std::int64_t xr, const Make& make) {
    if (place_.empty()) return Verdict::place;
    if (brings_light(place_.back()) ? kind != Kind::OP : place_.back()[0] != layer) return Verdict::place;
    if (!before(place_.back(), make)) return Verdict::stopped;
    if (!ends(kind, place_.back(), {xl, xr}, make)) return Verdict::stopped;
    return Verdict::itself;
  }

  Verdict near_cap(const Fields& field, const Make& make) {
    const Run run{field(l_.nc_xl), field(l_.nc_xr)};
    const Verdict v = span(Kind::NC, 1, run.xl, run.xr, make);
    if (v != Verdict::itself || run.xl != 0 || run.xr != width_) return v;
    PlainSpan inside{.kind = Kind::IF};
    inside.w = field(l_.nc_w);
    return make(inside) ? Verdict::done : Verdict::stopped;
  }

  Verdict end_line(const Make& make) {
    if (!before({3, 0, 0, 0, 0}, make)) return Verdict::stopped;
    if (!volumes_over(make)) return Verdict::stopped;
    ++line_;
    place_.clear();
    lit_.clear();
    polygons_.erase(
        std::remove_if(polygons_.begin(), polygons_.end(), [&](const Polygon& p) { return p.end <= line_; }),
        polygons_.end());
    for (Polygon& p : polygons_) p.made = false;
    return Verdict::itself;
  }

  /// Polygons whose span is still to be made, by place; of one place those first that began last, and of one line in
  /// its order.
  template <class Want>
  std::vector<Polygon*> in_order(Want want) {
    std::vector<Polygon*> due;
    for (Polygon& p : polygons_)
      if (!p.made && want(p)) due.push_back(&p);
    std::stable_sort(due.begin(), due.end(), [](const Polygon* a, const Polygon* b) {
      return a->place != b->place ? a->place < b->place : a->first < b->first;
    });
    return due;
  }

  /// The spans of all polygons at places before this one, and of those at it.
  bool before(const Place& place, const Make& make, bool at_it = false) {
    const std::vector<Polygon*> due =
        in_order([&](const Polygon& p) { return p.place < place || (at_it && p.place == place); });
    return std::all_of(due.begin(), due.end(), [&](Polygon* p) { return made(*p, make); });
  }

  /// The first line whose centre is not above a height.
  static std::int64_t first_below(std::int64_t y) { return static_cast<std::int64_t>(ceiling_of(y - 128, 256)); }

  /// The first pixel whose centre is not left of the edge on this line's centre.
  [[nodiscard]] std::int64_t crossing(const Edge& e) {
    const Int128 dx = e.x1 - e.x0;
    const Int128 dy = e.y1 - e.y0;
    loose_ = loose_ || (first_below(e.y1) <= line_ && (dx < -65536 * dy || dx >= 65536 * dy));
    if (dy <= 0) return 0;
    // 256 p + 128 >= x0 + dx (256 y + 128 - y0) / dy
    const Int128 p = ceiling_of((e.x0 - 128) * dy + (256 * Int128{line_} + 128 - e.y0) * dx, 256 * dy);
    return std::clamp<std::int64_t>(wrap(p, 17), 0, width_);
  }

  /// Start and step of a plane along a run, in fields of 10 or Z_BITS + 2 bits and a fraction.
  void ramp(const Polygon& p, const Plane& plane, const Run& run, int bits, int frac, std::int64_t& start,
            std::int64_t& step) const {
    const Int128 value =
        Int128{plane.value} + Int128{plane.down} * (line_ - p.first + 1) + Int128{plane.right} * run.xl;
    const Int128 unit = static_cast<Int128>(1) << (24 - frac);
    const auto nearest = [&](Int128 v) { return floor_of(2 * v + unit, 2 * unit); };
    const Int128 half = frac > 0 ? static_cast<Int128>(1) << (frac - 1) : 0;
    start = wrap(nearest(value) + half, bits + frac);
    step = run.xr - run.xl == 1 ? 0 : wrap(nearest(plane.right), bits + frac);
  }

  bool made(Polygon& p, const Make& make) {
    p.made = true;
    const std::int64_t down = crossing(p.edges[0]);
    const std::int64_t up = crossing(p.edges[1]);
    const Run run{std::min(down, up), std::max(down, up)};
    if (run.xl == run.xr) return true;
    static constexpr std::array<Kind, 3> kKinds{Kind::OP, Kind::SP, Kind::TP};
    PlainSpan s{.kind = kKinds[static_cast<std::size_t>(p.place[0])], .xl = run.xl, .xr = run.xr};
    if (brings_light(p.place)) s.kind = Kind::OP;
    // Where the edge that goes up is at the left, the polygon is seen from the other side.
    if (c_.dsf_bits > 0) s.w = wrap(up < down ? -p.w : p.w, c_.dsf_bits + 1);
    if (s.kind == Kind::SP && s.w % (std::int64_t{1} << c_.dsf_bits) == 0) return true;
    s.normal_class = p.normal_class;
    s.alpha = p.alpha;
    ramp(p, p.depth, run, c_.z_bits + 2, c_.z_frac, s.z, s.dz);
    for (std::size_t i = 0; i < static_cast<std::size_t>(c_.channels); ++i) {
      if (c_.smooth != 0)
        ramp(p, p.color[i], run, 10, c_.color_frac, s.color[i], s.dcolor[i]);
      else
        s.color[i] = p.color[i].value >> 24;
    }
    return ends(s.kind, p.place, run, make) && make(s);
  }

  /// Ends the volume and the sample that are over before a span at this place; then the span belongs to its volume.
  bool ends(Kind kind, const Place& place, const Run& run, const Make& make) {
    if (brings_light(place)) return light_comes(place, make);
    if (kind == Kind::OP) return true;
    if (kind == Kind::TP) return volumes_over(make);
    const bool same_sample = std::equal(place.begin(), place.begin() + 3, of_.begin());
    const bool same_volume = same_sample && place[3] == of_[3];
    if (!volume_.empty() && !same_volume && !volume_over(make)) return false;
    if (!sample_.empty() && !same_sample && !sample_over(make)) return false;
    of_ = place;
    lit_.clear();
    volume_.push_back(run);
    return true;
  }

  /// The first of a light's spans on a line has the light's RESOLVE before it, and before that the ends of its volumes.
  bool light_comes(const Place& place, const Make& make) {
    const std::vector<std::int64_t> light(place.begin(), place.begin() + 4);
    if (lit_ == light) return true;
    if (!volume_.empty() && !volume_over(make)) return false;
    if (!sample_.empty() && !sample_over(make)) return false;
    lit_ = light;
    return make({.kind = Kind::RESOLVE, .samples = place[3] % (std::int64_t{1} << c_.count_bits)});
  }

  static PlainSpan end_of(Kind kind, const std::vector<Run>& runs) {
    PlainSpan s{.kind = kind, .xl = runs[0].xl, .xr = runs[0].xr};
    for (const Run& r : runs) {
      s.xl = std::min(s.xl, r.xl);
      s.xr = std::max(s.xr, r.xr);
    }
    return s;
  }

  bool volume_over(const Make& make) {
    const PlainSpan ev = end_of(Kind::EV, volume_);
    sample_.insert(sample_.end(), volume_.begin(), volume_.end());
    volume_.clear();
    return c_.fsf == 0 || make(ev);
  }

  bool sample_over(const Make& make) {
    PlainSpan es = end_of(Kind::ES, sample_);
    es.light = of_[2];
    sample_.clear();
    return c_.count_bits == 0 || make(es);
  }

  bool volumes_over(const Make& make) {
    if (volume_.empty()) return true;  // a sample is over only where another volume begins
    return volume_over(make) && sample_over(make) && make({.kind = Kind::RESOLVE});
  }

  Config c_;
  Layout l_;
  std::int64_t width_;
  std::int64_t line_ = 0;
  std::vector<Place> place_;  // of the line's ATs
  std::vector<Polygon> polygons_;
  bool waits_ = false;  // a polygon for its edges
  bool loose_ = false;
  Polygon fresh_;
  std::vector<Run> volume_, sample_;  // what the open ones have
  std::vector<std::int64_t> lit_;     // the place but for its rank of the light that has its RESOLVE
  Place of_{};                        // of them
};

}  // namespace kage::verif
