// SPDX-License-Identifier: Apache-2.0
//
// The front end: tokens of a frame at the polygon level in, tokens of the span level out (docs/stream.md, "The polygon
// level"; rtl/front_end.sv). It keeps the polygons that cross the line at hand in the order of their places and merges
// with them what the line brings.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "contract/kinds.hpp"
#include "polygon/active_polygon.hpp"
#include "polygon/place.hpp"
#include "polygon/volume_ends.hpp"

namespace kage {

class FrontEnd {
 public:
  explicit FrontEnd(const Config& config) : config_(config), ends_(config) {}

  /// A frame begins whose header has been accepted.
  void start(int width) {
    width_ = width;
    line_ = 0;
    active_.clear();
    next_.clear();
    most_ = 0;
    start_line();
  }

  /// The most polygons that the frame has had at once: the least ACTIVE that takes it.
  [[nodiscard]] std::size_t most() const { return most_; }

  /// Takes the frame's next token, of a kind that the configuration has. Calls emit(token, made) in order for each
  /// token of the span level that comes of it: `made` by the front end, or as it came.
  /// @return NONE, or the first other result of emit(), or the token's own error; after an error only start() may
  /// follow
  template <class Emit>
  ErrorCode accept(const Token& t, Emit emit) {
    const auto make = [&emit](const Token& token) { return emit(token, true); };
    // Nothing may come between a POLYGON and its edges.
    if (begun_ && !completes(t.kind)) return ErrorCode::PLACE;
    if (info_of(t.kind).span) return span(t, make, emit);
    switch (t.kind) {
      case Kind::AT:
        return go_to(t);
      case Kind::POLYGON:
        return begin(t, make);
      case Kind::GRADIENT:
        return gradient(t.polygon);
      case Kind::EDGE:
        return edge(t.polygon, make);
      case Kind::EOL:
        return end_line(t, make, emit);
      default:
        return emit(t, false);
    }
  }

  /// Polygons that have begun on lines above and cross the one at hand.
  [[nodiscard]] std::size_t crossing() const { return active_.size(); }

 private:
  void start_line() {
    placed_ = begun_ = false;
    at_ = 0;
    have_ = {};
    ends_.start();
  }

  /// Whether a POLYGON waits for it.
  [[nodiscard]] static constexpr bool completes(Kind kind) {
    switch (kind) {
      case Kind::EDGE:
      case Kind::GRADIENT:
        return true;
      default:
        return false;
    }
  }

  /// Whether a span of this kind belongs to the line's place.
  [[nodiscard]] bool belongs(Kind kind) const {
    const auto layer = static_cast<Layer>(place_.layer());
    if (layer == Layer::volumes)
      return kind == Kind::OP ? place_.is_light(config_) : kind != Kind::TP && !place_.is_light(config_);
    return kind == (layer == Layer::opaque ? Kind::OP : Kind::TP);
  }
  [[nodiscard]] bool has(int layer) const {
    return layer == 0 || (layer == 1 && config_.dsf_bits > 0) || (layer == 2 && config_.translucency > 0);
  }

  ErrorCode go_to(const Token& t) {
    const Place to(t.polygon, t.table.light);
    const bool has_light =
        to.layer() != static_cast<int>(Layer::volumes) || to.light() < derived::place_lights(config_);
    if (!has(to.layer()) || !has_light || (placed_ && to < place_)) return ErrorCode::PLACE;
    place_ = to;
    placed_ = true;
    return ErrorCode::NONE;
  }

  template <class Make>
  ErrorCode begin(const Token& t, Make make) {
    if (!placed_) return ErrorCode::PLACE;
    // One that is there at this very place comes first.
    if (const ErrorCode e = make_while([this](Place p) { return p <= place_; }, make); e != ErrorCode::NONE) return e;
    begun_ = true;
    have_ = {};
    fresh_ = ActivePolygon(config_, place_, t);
    return ErrorCode::NONE;
  }

  ErrorCode gradient(const PolygonToken& t) {
    if (!begun_ || t.channel >= config_.channels) return ErrorCode::PLACE;
    fresh_.color[static_cast<std::size_t>(t.channel)] = WalkedPlane(t);
    return ErrorCode::NONE;
  }

  template <class Make>
  ErrorCode edge(const PolygonToken& t, Make make) {
    if (!begun_) {
      if (!placed_) return ErrorCode::PLACE;
      if (const ErrorCode e = make_before(place_, make); e != ErrorCode::NONE) return e;
      if (at_ == active_.size() || active_[at_].place != place_) return ErrorCode::PLACE;
      active_[at_].set_edge(t, ActivePolygon::edge_at(t, line_));
      return ErrorCode::NONE;
    }
    fresh_.set_edge(t, ActivePolygon::edge_at(t, line_));
    have_[static_cast<std::size_t>(t.side)] = true;
    if (!have_[0] || !have_[1]) return ErrorCode::NONE;
    const std::size_t kept = next_.size() + (active_.size() - at_);
    if (kept >= static_cast<std::size_t>(config_.active)) return ErrorCode::ACTIVE_FULL;
    most_ = std::max(most_, kept + 1);
    begun_ = false;
    return make_span(fresh_, make);
  }

  template <class Make, class Emit>
  ErrorCode span(const Token& t, Make make, Emit emit) {
    if (!placed_ || !belongs(t.kind)) return ErrorCode::PLACE;
    if (const ErrorCode e = make_before(place_, make); e != ErrorCode::NONE) return e;
    if (const ErrorCode e = before(place_, t.span, make); e != ErrorCode::NONE) return e;
    if (t.kind != Kind::NC || t.span.xl != 0 || t.span.xr != width_) return emit(t, false);
    Token whole = t;
    whole.kind = Kind::IF;
    return emit(whole, false);
  }

  template <class Make, class Emit>
  ErrorCode end_line(const Token& t, Make make, Emit emit) {
    while (at_ < active_.size())
      if (const ErrorCode e = make_span(active_[at_++], make); e != ErrorCode::NONE) return e;
    if (const ErrorCode e = ends_.end(make); e != ErrorCode::NONE) return e;
    active_.swap(next_);
    next_.clear();
    start_line();
    ++line_;
    return emit(t, false);
  }

  /// Make the spans of the polygons that come before a place.
  template <class Make>
  ErrorCode make_before(Place place, Make make) {
    return make_while([place](Place p) { return p < place; }, make);
  }

  /// Make the spans of the next polygons as long as their places are sooner().
  template <class Sooner, class Make>
  ErrorCode make_while(Sooner sooner, Make make) {
    while (at_ < active_.size() && sooner(active_[at_].place))
      if (const ErrorCode e = make_span(active_[at_++], make); e != ErrorCode::NONE) return e;
    return ErrorCode::NONE;
  }

  template <class Make>
  ErrorCode make_span(ActivePolygon& p, Make make) {
    Token t;
    t.span = p.span(config_, width_);
    t.kind = kind_at(p.place);
    const Place place = p.place;
    if (p.end > line_ + 1) {
      p.next();
      next_.push_back(p);
    }
    const auto weight = static_cast<unsigned>(t.span.w) & derived::most_dsf(config_);
    if (t.span.xl == t.span.xr || (t.kind == Kind::SP && weight == 0)) return ErrorCode::NONE;
    if (const ErrorCode e = before(place, t.span, make); e != ErrorCode::NONE) return e;
    return make(t);
  }

  [[nodiscard]] Kind kind_at(Place place) const {
    switch (static_cast<Layer>(place.layer())) {
      case Layer::opaque:
        return Kind::OP;
      case Layer::translucent:
        return Kind::TP;
      case Layer::volumes:
        break;
    }
    return place.is_light(config_) ? Kind::OP : Kind::SP;
  }

  /// Makes what stands before a span at this place: the ends of volumes and samples, and the RESOLVE of a light.
  template <class Make>
  ErrorCode before(Place place, const SpanToken& s, Make make) {
    if (place.is_light(config_)) return ends_.light(place, make);
    if (place.layer() == static_cast<int>(Layer::volumes)) return ends_.token(place, s.xl, s.xr, make);
    return place.layer() == static_cast<int>(Layer::translucent) ? ends_.end(make) : ErrorCode::NONE;
  }

  Config config_;
  VolumeEnds ends_;
  int width_ = 0;
  int line_ = 0;
  std::vector<ActivePolygon> active_;  // that cross the line, by place
  std::vector<ActivePolygon> next_;    // that cross the next one
  std::size_t at_ = 0;                 // the first of active_ whose span is still to be made
  std::size_t most_ = 0;               // of both together, in the frame
  bool placed_ = false;                // the line has had an AT
  Place place_;                        // of its last
  bool begun_ = false;                 // a POLYGON waits for its edges
  std::array<bool, 2> have_{};
  ActivePolygon fresh_;
};

}  // namespace kage
