// SPDX-License-Identifier: Apache-2.0
//
// The words of a band of lines: what Band hands to it becomes tokens, each with where it comes from.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "frontend/frame_plan.hpp"
#include "frontend/polygon_layout.hpp"
#include "frontend/polygon_shape.hpp"
#include "frontend/polygon_spans.hpp"
#include "frontend/weight.hpp"
#include "kage/frontend.hpp"
#include "kage/token.hpp"

namespace kage {

class BandWords {
 public:
  /// With `origins` it keeps where spans come from.
  BandWords(const FramePlan& frame, bool origins)
      : f_(&frame),
        keeps_origins_(origins),
        g_(frame.geometry),
        layout_(frame.layout ? &*frame.layout : nullptr),
        writer_(*frame.config, words_) {}

  [[nodiscard]] std::span<const std::uint32_t> words() const { return words_; }

  /// Append the origins of the band's tokens.
  void add_origins(FrameOrigins& to) const {
    const auto append = [](std::vector<TokenOrigin>& all, const std::vector<TokenOrigin>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    for (int y = y0_; y < y1_; ++y) {
      const FrameOrigins& from = lines_[static_cast<std::size_t>(y - y0_)].origins;
      append(to.opaque, from.opaque);
      append(to.shadow, from.shadow);
      append(to.translucent, from.translucent);
    }
  }

  /// Add the spans that the band has as such.
  void add_spans(PolygonReport& to) const {
    for (std::size_t i = 0; i < to.ways.size(); ++i) to.ways[i] += written_.ways[i];
  }

  // ---- what Band calls

  /// Spans that count at no pixel are written if all are to be.
  static constexpr bool kSkips = false;

 private:
  struct Line {
    std::vector<std::uint32_t> opaque;
    std::vector<std::uint32_t> shadow;
    std::vector<std::uint32_t> translucent;
    FrameOrigins origins;
    std::optional<Place> place;  // of the last AT

    void clear() {
      origins.opaque.clear();
      origins.shadow.clear();
      origins.translucent.clear();
      opaque.clear();
      shadow.clear();
      translucent.clear();
      place.reset();
    }
  };

 public:
  /// A polygon in one of its roles: where its tokens go, and the values that all of them have.
  struct Role {
    std::uint32_t polygon;
    PolygonWay way;
    Place place;
    std::vector<std::uint32_t> Line::*words;
    SpanToken look;                   // of its POLYGON
    std::optional<std::size_t> pass;  // of its colour, if it has one
  };

  void start(int y0, int y1) {
    y0_ = y0;
    y1_ = y1;
    words_.clear();
    written_ = {};
    for (Line& line : lines_) line.clear();
  }

  /// All has come.
  void end(const BandWork& work) {
    const bool tree = f_->tree.any();
    std::vector<std::vector<std::uint32_t>> ahead;  // segments of line y + 1 at y - y0_
    if (tree) f_->tree.segments(y0_ + 1, std::min(y1_ + 1, g_->height), work.tree_edges, ahead);
    for (int y = y0_; y < y1_; ++y) {
      const Line& line = at(y);
      if (tree) {
        const auto i = static_cast<std::size_t>(y - y0_);
        if (i < ahead.size()) words_.insert(words_.end(), ahead[i].begin(), ahead[i].end());
        writer_.write_to(words_);
        writer_.tree();
      }
      words_.insert(words_.end(), line.opaque.begin(), line.opaque.end());
      words_.insert(words_.end(), line.shadow.begin(), line.shadow.end());
      writer_.write_to(words_);
      if (!line.shadow.empty() && layout_ == nullptr && g_->passes.empty()) writer_.resolve();
      words_.insert(words_.end(), line.translucent.begin(), line.translucent.end());
      writer_.eol(y);
    }
  }

  [[nodiscard]] Role opaque(std::uint32_t polygon) const {
    return drawn_role(polygon, Layer::opaque, [&] { return layout_->opaque(polygon); });
  }
  [[nodiscard]] Role lit(std::size_t pass, std::uint32_t polygon) const {
    Role role{polygon, PolygonWay::polygon, {}, &Line::shadow, {}, 1 + pass};
    if (layout_ == nullptr) return role;
    const PolygonLayout::Use use = layout_->lit(pass, polygon);
    role.way = use.way;
    role.place = layout_->light_place(pass, use.before);
    return role;
  }
  /// The n-th polygon of a fragment.
  [[nodiscard]] Role translucent(std::uint32_t fragment, std::uint32_t n) const {
    return drawn_role(g_->fragments[fragment].first_polygon + n, Layer::translucent,
                      [&] { return layout_->translucent(fragment, n); });
  }
  [[nodiscard]] Role face(std::uint32_t number, std::uint32_t volume) const {
    const VolumeFace& face = g_->volume_faces[number];
    Role role{face.polygon, PolygonWay::polygon, {}, &Line::shadow, {}, std::nullopt};
    if (layout_ == nullptr) return role;
    const PolygonLayout::Use use = layout_->face(number);
    role.way = use.way;
    role.place = layout_->place(volume, use.before);
    role.look.w = weight(*f_->config, face.w);
    return role;
  }
  /// The same behind the volume's polygons that go as such.
  [[nodiscard]] Role last_face(std::uint32_t number, std::uint32_t volume) const {
    Role role = face(number, volume);
    if (layout_ != nullptr) role.place = layout_->place(volume, layout_->made_of(volume));
    return role;
  }

  /// Whether the core's front end makes the spans, of which Band tells all the same.
  [[nodiscard]] bool made(const Role& role) const { return layout_ != nullptr && role.way == PolygonWay::polygon; }
  /// Whether anybody asks for such spans.
  [[nodiscard]] bool wants_made() const { return keeps_origins_; }

  /// The tokens of a polygon that goes as such, on the lines where its edges begin.
  void polygon(const Role& role) {
    const ScreenPolygon& p = g_->polygons[role.polygon];
    const PolygonShape& shape = layout_->shape(role.polygon);
    bool begun = false;
    each_edge(g_->outline(p), shape, y0_, y1_, [&](int y, const PolygonToken& edge) {
      writer_.write_to(at(y).*role.words);
      go_to(at(y), role.place);
      if (y == shape.first && !begun) {
        begun = true;
        writer_.polygon(depth_of(*f_->config, p, y), role.look);
        const bool varies = f_->config->smooth != 0 && has_color_planes(p) && role.pass;
        for (int c = 0; varies && c < f_->config->channels; ++c)
          writer_.gradient(gradient_of(*g_, *f_->config, p, y, c, *role.pass));
      }
      writer_.edge(edge);
    });
  }

  void op(int y, const Role& role, const SpanToken& s) {
    if (!made(role)) {
      before_span(at(y), role);
      writer_.op(s);
    }
    if (keeps_origins_) at(y).origins.opaque.push_back({role.polygon, TokenOrigin::kNone});
  }
  void tp(int y, const Role& role, const SpanToken& s) {
    if (!made(role)) {
      before_span(at(y), role);
      writer_.tp(s);
    }
    if (keeps_origins_) at(y).origins.translucent.push_back({role.polygon, TokenOrigin::kNone});
  }
  /// Returns whether it may count at a pixel.
  bool sp(int y, const Role& role, std::uint32_t volume, const SpanToken& s) {
    if (!made(role)) {
      before_span(at(y), role);
      writer_.sp(s);
    }
    if (keeps_origins_) at(y).origins.shadow.push_back({role.polygon, volume});
    return true;
  }
  /// Pixels that count whatever their depth.
  void near(int y, std::uint32_t volume, int xl, int xr, int w) {
    Line& line = at(y);
    writer_.write_to(line.shadow);
    if (layout_ != nullptr) go_to(line, layout_->place(volume, layout_->made_of(volume)));
    if (xl == 0 && xr == g_->width && layout_ == nullptr)
      writer_.inside(w);
    else
      writer_.nc(xl, xr, w);
    if (keeps_origins_) line.origins.shadow.push_back({TokenOrigin::kNone, volume});
  }
  // At the polygon level the core's front end makes these three.
  void ev(int y, std::uint32_t volume, int xl, int xr) {
    if (layout_ == nullptr) {
      writer_.write_to(at(y).shadow);
      writer_.ev(xl, xr);
    }
    if (keeps_origins_) at(y).origins.shadow.push_back({TokenOrigin::kNone, volume});
  }
  void es(int y, int xl, int xr, int light) {
    if (layout_ != nullptr) return;
    writer_.write_to(at(y).shadow);
    writer_.es(xl, xr, light);
  }
  void resolve(int y, int samples) {
    if (layout_ != nullptr) return;
    writer_.write_to(at(y).shadow);
    writer_.resolve(samples);
  }

 private:
  Line& at(int y) { return lines_[static_cast<std::size_t>(y - y0_)]; }

  /// The role of a drawn polygon, opaque or translucent; use() is called at the polygon level only.
  template <class Use>
  Role drawn_role(std::uint32_t polygon, Layer layer, Use use) const {
    const ScreenPolygon& p = g_->polygons[polygon];
    const bool opaque = layer == Layer::opaque;
    Role role{polygon, PolygonWay::polygon, {}, opaque ? &Line::opaque : &Line::translucent, {}, 0};
    if (layout_ == nullptr) return role;
    if (opaque && p.light_planes < 0) role.look.normal_class = span_class(p, *f_->config);
    const PolygonLayout::Use as = use();
    role.way = as.way;
    role.place = Place(layer, as.before);
    if (!opaque) role.look.alpha = p.alpha;
    for (std::size_t c = 0; c < static_cast<std::size_t>(f_->config->channels); ++c) role.look.color[c] = p.color[c];
    return role;
  }

  /// Gives the next tokens of a line this place: writes an AT unless the line is there already.
  void go_to(Line& line, const Place& place) {
    if (line.place == place) return;
    line.place = place;
    writer_.at(place.token(), place.light());
  }

  /// A line is to have a span of a polygon that does not go as such.
  void before_span(Line& line, const Role& role) {
    writer_.write_to(line.*role.words);
    if (layout_ == nullptr) return;
    go_to(line, role.place);
    auto& of = written_.ways[static_cast<std::size_t>(role.way)];
    ++of.spans;
    of.tall_spans += layout_->shape(role.polygon).lines() >= kTallLines ? 1 : 0;
  }

  const FramePlan* f_;
  bool keeps_origins_;
  const FrameGeometry* g_;
  const PolygonLayout* layout_;  // at the polygon level
  int y0_ = 0;
  int y1_ = 0;
  std::vector<std::uint32_t> words_;
  TokenWriter writer_;
  PolygonReport written_;  // spans alone
  std::array<Line, kBandLines> lines_;
};

}  // namespace kage
