// SPDX-License-Identifier: Apache-2.0
//
// The words of a band of lines.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "frontend/cut.hpp"
#include "frontend/polygon_layout.hpp"
#include "frontend/polygon_shape.hpp"
#include "frontend/polygon_spans.hpp"
#include "frontend/scan.hpp"
#include "frontend/sweep.hpp"
#include "frontend/tree_layout.hpp"
#include "frontend/weight.hpp"
#include "kage/frontend.hpp"
#include "kage/token.hpp"

namespace kage {

/// Data of a frame that all bands share.
struct FramePlan {
  const FrameGeometry* geometry;
  const Config* config;
  TreeLayout tree;
  std::vector<std::uint32_t> volume_of_face;
  std::vector<std::uint32_t> volume_of_edge;
  Sweep polygons;
  Sweep faces;
  Sweep edges;
  Sweep tree_edges;
  Sweep fragments;
  std::optional<PolygonLayout> layout;  // at the polygon level
};

/// Numbers of the polygons, faces, edges and fragments that touch a band.
struct BandWork {
  std::vector<std::uint32_t> polygons;
  std::vector<std::uint32_t> faces;
  std::vector<std::uint32_t> edges;
  std::vector<std::uint32_t> tree_edges;  // of the lines ahead: one further down than the band's
  std::vector<std::uint32_t> fragments;
};

/// Makes the words of one band after the other; keeps its buffers.
class Band {
 public:
  /// With `origins` it keeps where spans come from.
  Band(const FramePlan& frame, bool origins)
      : f_(&frame),
        keeps_origins_(origins),
        g_(frame.geometry),
        layout_(frame.layout ? &*frame.layout : nullptr),
        writer_(*frame.config, words_),
        spans_(*frame.geometry, *frame.config) {}

  /// The next band's work, to be filled in before make().
  BandWork& work() { return work_; }
  [[nodiscard]] std::span<const std::uint32_t> words() const { return words_; }

  /// Append the origins of the band's tokens, after make().
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

  /// Add the spans that the band has as such, after make().
  void add_spans(PolygonReport& to) const {
    for (std::size_t i = 0; i < to.ways.size(); ++i) to.ways[i] += written_.ways[i];
  }

  void make(int band) {
    y0_ = band * kBandLines;
    y1_ = std::min(y0_ + kBandLines, g_->height);
    words_.clear();
    written_ = {};
    for (Line& line : lines_) line.clear();
    kept_.clear();
    opaque();
    if (f_->config->dsf_bits > 0) volumes();
    if (f_->config->translucency > 0) translucent();
    const bool tree = f_->tree.any();
    std::vector<std::vector<std::uint32_t>> ahead;  // segments of line y + 1 at y - y0_
    if (tree) f_->tree.segments(y0_ + 1, std::min(y1_ + 1, g_->height), work_.tree_edges, ahead);
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

 private:
  /// Pixels that shadow tokens have touched.
  struct Touched {
    int from = 0;
    int to = 0;

    [[nodiscard]] bool none() const { return from == to; }
    void add(int xl, int xr) {
      from = none() ? xl : std::min(from, xl);
      to = std::max(to, xr);
    }
  };

  struct Line {
    std::vector<std::uint32_t> opaque;
    std::vector<std::uint32_t> shadow;
    std::vector<std::uint32_t> translucent;
    std::vector<Crossing> near;  // of the volume being worked on
    Touched volume;
    Touched sample;          // of light
    std::size_t passes = 0;  // lights whose RESOLVE has come
    bool open = false;       // volumes have come, and no RESOLVE behind them
    FrameOrigins origins;
    std::optional<Place> place;  // of the last AT

    void clear() {
      origins.opaque.clear();
      origins.shadow.clear();
      origins.translucent.clear();
      opaque.clear();
      shadow.clear();
      translucent.clear();
      near.clear();
      volume = {};
      sample = {};
      passes = 0;
      open = false;
      place.reset();
    }
  };

  Line& at(int y) { return lines_[static_cast<std::size_t>(y - y0_)]; }

  /// A polygon in one of its roles: where its tokens go, and the values that all of them have.
  struct Role {
    PolygonWay way;
    Place place;
    std::vector<std::uint32_t> Line::*words;
    SpanToken look;                   // of its POLYGON
    std::optional<std::size_t> pass;  // of its colour, if it has one
  };

  /// A span of an opaque polygon, which comes again with each light.
  struct Kept {
    std::uint32_t polygon;
    int y;
    SpanToken span;
  };

  [[nodiscard]] bool made(PolygonWay way) const { return layout_ != nullptr && way == PolygonWay::polygon; }

  /// The role of a drawn polygon, opaque or translucent; use() is called at the polygon level only.
  template <class Use>
  Role drawn_role(const ScreenPolygon& p, Layer layer, Use use) const {
    const bool opaque = layer == Layer::opaque;
    Role role{PolygonWay::polygon, {}, opaque ? &Line::opaque : &Line::translucent, {}, 0};
    if (opaque && p.light_planes < 0) role.look.normal_class = span_class(p, *f_->config);
    if (layout_ == nullptr) return role;
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

  /// The tokens of a polygon, on the lines where its edges begin.
  void polygon(std::uint32_t number, const Role& role) {
    const ScreenPolygon& p = g_->polygons[number];
    const PolygonShape& shape = layout_->shape(number);
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

  /// A line is to have a span of a polygon that does not go as such.
  void before_span(Line& line, std::uint32_t number, const Role& role) {
    writer_.write_to(line.*role.words);
    if (layout_ == nullptr) return;
    go_to(line, role.place);
    auto& of = written_.ways[static_cast<std::size_t>(role.way)];
    ++of.spans;
    of.tall_spans += layout_->shape(number).lines() >= kTallLines ? 1 : 0;
  }

  void opaque() {
    const bool again = !g_->passes.empty();
    for (const std::uint32_t i : work_.polygons) {
      const bool in_unit = i < f_->tree.first_span_polygon();
      if (in_unit && !again) continue;
      const ScreenPolygon& p = g_->polygons[i];
      const Role role = drawn_role(p, Layer::opaque, [&] { return layout_->opaque(i); });
      const bool as_polygon = made(role.way);
      if (as_polygon) polygon(i, role);
      if (as_polygon && !keeps_origins_ && !again) continue;
      spans_.each(p, y0_, y1_, [&](int y, SpanToken& s, int) {
        if (!in_unit) drawn_span(i, role, as_polygon, y, s);
        if (again) kept_.push_back({i, y, s});
      });
    }
  }

  /// A span of an opaque polygon in a pass, unless the front end makes it.
  void drawn_span(std::uint32_t number, const Role& role, bool as_polygon, int y, SpanToken s) {
    const auto keep_origin = [&] {
      if (keeps_origins_) at(y).origins.opaque.push_back({number, TokenOrigin::kNone});
    };
    if (as_polygon) return keep_origin();
    spans_.painted(g_->polygons[number], y, s, *role.pass, [&](const SpanToken& part) {
      before_span(at(y), number, role);
      writer_.op(part);
      keep_origin();
    });
  }

  // A fragment's span is a part of its face's, with the face's depth and colour there, bit for bit.
  void translucent() {
    for (const std::uint32_t i : work_.fragments) {
      const ScreenFragment& f = g_->fragments[i];
      const auto cuts = std::span(g_->cuts).subspan(f.first_cut, f.cut_count);
      const int y0 = std::max(y0_, f.first_line);
      const int y1 = std::min(y1_, f.end_line);
      for (std::uint32_t k = f.first_polygon; k < f.first_polygon + f.polygon_count; ++k) {
        const ScreenPolygon& p = g_->polygons[k];
        const Role role =
            drawn_role(p, Layer::translucent, [&] { return layout_->translucent(i, k - f.first_polygon); });
        const bool as_polygon = made(role.way);
        if (as_polygon) polygon(k, role);
        if (as_polygon && !keeps_origins_) continue;
        spans_.each(p, y0, y1, [&](int y, SpanToken& s, int) {
          if (as_polygon) {
            at(y).origins.translucent.push_back({k, TokenOrigin::kNone});
            return;
          }
          int xl = s.xl;
          int xr = s.xr;
          for (const FragmentCut& cut : cuts) restrict_to(g_->cut_lines[cut.line], cut.front, y, xl, xr);
          if (xl >= xr) return;
          s.alpha = p.alpha;
          spans_.painted(p, y, s, 0, [&](SpanToken part) {
            const int from = std::max(part.xl, xl);
            const int to = std::min(part.xr, xr);
            if (from >= to) return;
            const int on = from - part.xl;
            for (std::size_t c = 0; c < 3; ++c) part.color[c] += on * part.dcolor[c];
            PolygonSpans::restrict(part, from, to);
            before_span(at(y), k, role);
            writer_.tp(part);
            if (keeps_origins_) at(y).origins.translucent.push_back({k, TokenOrigin::kNone});
          });
        });
      }
    }
  }

  void volumes() {
    const auto& faces = work_.faces;
    const auto& edges = work_.edges;
    std::size_t face = 0;
    std::size_t edge = 0;
    std::uint32_t sample = 0;
    std::size_t pass = 0;  // of lights that have come
    while (face < faces.size() || edge < edges.size()) {
      std::uint32_t v = ~0U;
      if (face < faces.size()) v = f_->volume_of_face[faces[face]];
      if (edge < edges.size()) v = std::min(v, f_->volume_of_edge[edges[edge]]);
      if (g_->volumes[v].sample != sample) close_sample(sample);
      sample = g_->volumes[v].sample;
      for (; !g_->passes.empty() && pass < g_->sample_light[sample]; ++pass) light(pass);
      for (; face < faces.size() && f_->volume_of_face[faces[face]] == v; ++face) volume_face(faces[face], v);
      for (; edge < edges.size() && f_->volume_of_edge[edges[edge]] == v; ++edge)
        near_edge(g_->near_edges[edges[edge]]);
      close_volume(v);
    }
    close_sample(sample);
    for (; pass < g_->passes.size(); ++pass) light(pass);
    // A line without a surface has volumes that no light's spans follow.
    for (int y = y0_; y < y1_ && layout_ == nullptr && !g_->passes.empty(); ++y)
      if (at(y).open) resolve(at(y), 0);
  }

  void resolve(Line& line, int samples) {
    writer_.write_to(line.shadow);
    writer_.resolve(samples);
    line.open = false;
  }

  /// The opaque spans once more, with a light's colours, those of units too: behind its volumes.
  void light(std::size_t pass) {
    const int samples = f_->config->count_bits > 0 ? g_->passes[pass] : 0;
    auto span = kept_.begin();
    for (const std::uint32_t i : work_.polygons) {
      Role role{PolygonWay::polygon, {}, &Line::shadow, {}, 1 + pass};
      if (layout_ != nullptr) {
        const PolygonLayout::Use use = layout_->lit(pass, i);
        role.way = use.way;
        role.place = layout_->light_place(pass, use.before);
      }
      const bool as_polygon = made(role.way);
      if (as_polygon) polygon(i, role);
      for (; span != kept_.end() && span->polygon == i; ++span) {
        Line& line = at(span->y);
        if (layout_ == nullptr && line.passes == pass) resolve(line, samples);
        line.passes = pass + 1;
        drawn_span(i, role, as_polygon, span->y, span->span);
      }
    }
  }

  void volume_face(std::uint32_t number, std::uint32_t volume) {
    const VolumeFace& face = g_->volume_faces[number];
    Role role{PolygonWay::polygon, {}, &Line::shadow, {}, std::nullopt};
    if (layout_ != nullptr) {
      const PolygonLayout::Use use = layout_->face(number);
      role.way = use.way;
      role.place = layout_->place(volume, use.before);
      role.look.w = weight(*f_->config, face.w);
    }
    const bool as_polygon = made(role.way);
    if (as_polygon) polygon(face.polygon, role);
    if (as_polygon && !keeps_origins_) return;
    spans_.each(g_->polygons[face.polygon], y0_, y1_, [&](int y, SpanToken& s, int winding) {
      s.w = weight(*f_->config, winding * face.w);
      if (s.w == 0) return;
      Line& line = at(y);
      if (!as_polygon) {
        before_span(line, face.polygon, role);
        writer_.sp(s);
      }
      if (keeps_origins_) line.origins.shadow.push_back({face.polygon, volume});
      line.volume.add(s.xl, s.xr);
    });
  }

  void near_edge(const NearEdge& e) {
    EdgeWalker walker(e.from, e.to);
    const int from = std::max(walker.first(), y0_);
    const int to = std::min(walker.end(), y1_);
    if (from >= to) return;
    walker.start(from);
    for (int y = from; y < to; ++y, walker.next()) at(y).near.push_back({walker.x(), walker.winding() * e.w});
  }

  void close_volume(std::uint32_t volume) {
    for (int y = y0_; y < y1_; ++y) {
      Line& line = at(y);
      if (!line.near.empty()) near_cap(line, volume);
      if (line.volume.none()) continue;
      if (f_->config->fsf != 0) {
        if (layout_ == nullptr) {
          writer_.write_to(line.shadow);
          writer_.ev(line.volume.from, line.volume.to);
        }
        if (keeps_origins_) line.origins.shadow.push_back({TokenOrigin::kNone, volume});
      }
      line.sample.add(line.volume.from, line.volume.to);
      line.open = true;
      line.volume = {};
    }
  }

  void close_sample(std::uint32_t sample) {
    if (f_->config->count_bits == 0 || layout_ != nullptr) return;
    for (int y = y0_; y < y1_; ++y) {
      Line& line = at(y);
      if (line.sample.none()) continue;
      writer_.write_to(line.shadow);
      writer_.es(line.sample.from, line.sample.to, g_->passes.empty() ? g_->sample_light[sample] : 0);
      line.sample = {};
    }
  }

  void near_cap(Line& line, std::uint32_t volume) {
    std::stable_sort(line.near.begin(), line.near.end(),
                     [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    writer_.write_to(line.shadow);
    fill_between(line.near, g_->width, [&](int xl, int xr, int winding) {
      const int w = weight(*f_->config, winding);
      if (w == 0) return;
      if (layout_ != nullptr) go_to(line, layout_->place(volume, layout_->made_of(volume)));
      if (xl == 0 && xr == g_->width && layout_ == nullptr)
        writer_.inside(w);
      else
        writer_.nc(xl, xr, w);
      if (keeps_origins_) line.origins.shadow.push_back({TokenOrigin::kNone, volume});
      line.volume.add(xl, xr);
    });
    line.near.clear();
  }

  const FramePlan* f_;
  bool keeps_origins_;
  const FrameGeometry* g_;
  const PolygonLayout* layout_;  // at the polygon level
  BandWork work_;
  int y0_ = 0;
  int y1_ = 0;
  std::vector<std::uint32_t> words_;
  TokenWriter writer_;
  PolygonSpans spans_;
  PolygonReport written_;  // spans alone
  std::vector<Kept> kept_;
  std::array<Line, kBandLines> lines_;
};

}  // namespace kage
