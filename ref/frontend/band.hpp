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

#include "frontend/band_effect.hpp"
#include "frontend/cut.hpp"
#include "frontend/polygon_layout.hpp"
#include "frontend/polygon_shape.hpp"
#include "frontend/polygon_spans.hpp"
#include "frontend/scan.hpp"
#include "frontend/sweep.hpp"
#include "frontend/tree_layout.hpp"
#include "frontend/uses.hpp"
#include "frontend/weight.hpp"
#include "kage/frontend.hpp"
#include "kage/token.hpp"

namespace kage {

/// Data of a frame that all bands share.
struct FramePlan {
  const FrameGeometry* geometry;
  const Config* config;
  TreeLayout tree;
  Uses uses;
  std::vector<std::uint32_t> volume_of_face;
  std::vector<std::uint32_t> volume_of_edge;
  Sweep polygons;
  Sweep faces;
  Sweep edges;
  Sweep tree_edges;
  Sweep fragments;
  bool all_spans;                       // those without effect too
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
  /// With `origins` it keeps where spans come from. With `words` it adds there what they take.
  Band(const FramePlan& frame, bool origins, SpanWords* words = nullptr)
      : f_(&frame),
        keeps_origins_(origins),
        span_words_(words),
        g_(frame.geometry),
        layout_(frame.layout ? &*frame.layout : nullptr),
        writer_(*frame.config, words_),
        spans_(*frame.geometry, *frame.config) {
    if (!frame.all_spans) effect_.emplace(*frame.config, frame.geometry->width);
  }

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
    drawn_.clear();
    parts_.clear();
    painted_ = 0;
    received_ = kNoLight;
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
  /// Pixels that count without a look at their depth.
  struct NearRun {
    int xl;
    int xr;
    int w;
  };

  /// A span of a volume's face.
  struct FaceSpan {
    std::uint32_t face;
    SpanToken span;
  };

  struct Line {
    std::vector<std::uint32_t> opaque;
    std::vector<std::uint32_t> shadow;
    std::vector<std::uint32_t> translucent;
    // These are of the volume being worked on:
    std::vector<Crossing> near;
    std::vector<NearRun> before_all;  // spans that lie before all that receives
    std::vector<FaceSpan> held;       // those that depth decides, until the volume has an effect
    PixelRange volume;                // pixels that its tokens have touched
    bool has_polygon = false;         // it has one that goes as such

    PixelRange sample;       // of light
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
      start_volume();
      sample = {};
      passes = 0;
      open = false;
      place.reset();
    }
    void start_volume() {
      near.clear();
      before_all.clear();
      held.clear();
      volume = {};
      has_polygon = false;
    }
  };

  /// Pixels that are no word's worth: so wide a gap between runs is filled.
  static constexpr int kWidestJoin = 16;
  static constexpr std::size_t kNoLight = ~std::size_t{0};

  Line& at(int y) { return lines_[static_cast<std::size_t>(y - y0_)]; }

  /// A polygon in one of its roles: where its tokens go, and the values that all of them have.
  struct Role {
    PolygonWay way;
    Place place;
    std::vector<std::uint32_t> Line::*words;
    SpanToken look;                   // of its POLYGON
    std::optional<std::size_t> pass;  // of its colour, if it has one
  };

  /// A span of an opaque polygon.
  struct Drawn {
    std::uint32_t polygon;
    int y;
    SpanToken span;
    std::size_t first_part;
    std::size_t part_count;
  };

  /// A part of such a span, of one colour or ramp, as the pass at hand draws it.
  struct Part {
    SpanToken span;
    PixelRange shown;
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
    if (effect_) effect_->start(y1_ - y0_);
    for (const std::uint32_t i : work_.polygons) {
      const ScreenPolygon& p = g_->polygons[i];
      if (i < f_->tree.first_span_polygon() && !again && !effect_) continue;
      spans_.each(p, y0_, y1_, [&](int y, SpanToken& s, int) {
        drawn_.push_back({i, y, s, parts_.size(), 0});
        spans_.painted(p, y, s, 0, [&](const SpanToken& part) {
          parts_.push_back({part, {part.xl, part.xr}});
          if (effect_) effect_->draw(y - y0_, part);
        });
        drawn_.back().part_count = parts_.size() - drawn_.back().first_part;
      });
    }
    if (effect_) {
      effect_->end_drawing();
      for (std::uint32_t n = 0; n < parts_.size(); ++n) parts_[n].shown = effect_->shown(n);
    }
    write_drawn(
        [&](std::uint32_t i) { return drawn_role(g_->polygons[i], Layer::opaque, [&] { return layout_->opaque(i); }); },
        Uses::drawn(0), f_->tree.first_span_polygon(), [](Line&) {});
  }

  /// The opaque polygons from a number on, by what parts_ shows of each, in the role that get_role(polygon) says; their
  /// uses begin with `first_use`. Calls start(line) before each span.
  template <class GetRole, class Start>
  void write_drawn(GetRole get_role, std::size_t first_use, std::uint32_t first_polygon, Start start) {
    auto drawn = drawn_.begin();
    for (const std::uint32_t i : work_.polygons) {
      const auto from = drawn;
      while (drawn != drawn_.end() && drawn->polygon == i) ++drawn;
      if (i < first_polygon) continue;
      const Role role = get_role(i);
      const bool as_polygon = made(role.way);
      if (as_polygon) polygon(i, role);
      for (auto d = from; d != drawn; ++d) {
        Line& line = at(d->y);
        for (std::size_t n = d->first_part; n < d->first_part + d->part_count; ++n) {
          const Part& part = parts_[n];
          if (!as_polygon && part.shown.none()) continue;
          start(line);
          if (!as_polygon) {
            before_span(line, i, role);
            writer_.op(restricted(part.span, part.shown));
            if (span_words_ != nullptr) span_words_->add(first_use + i, Kind::OP);
          }
          if (keeps_origins_) line.origins.opaque.push_back({i, TokenOrigin::kNone});
        }
      }
    }
  }

  /// A span in some of its pixels, with depth and colour as the whole has them there.
  [[nodiscard]] static SpanToken restricted(SpanToken s, const PixelRange& pixels) {
    const int on = pixels.first - s.xl;
    for (std::size_t c = 0; c < 3; ++c) s.color[c] += on * s.dcolor[c];
    PolygonSpans::restrict(s, pixels.first, pixels.end);
    return s;
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
            part = restricted(part, {from, to});
            if (effect_) {
              const PixelRange seen = effect_->before(y - y0_, part);
              if (seen.none()) return;
              part = restricted(part, seen);
            }
            before_span(at(y), k, role);
            writer_.tp(part);
            if (span_words_ != nullptr) span_words_->add(f_->uses.translucent(i, k - f.first_polygon), Kind::TP);
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
    const auto start_sample = [&](std::uint32_t next) {
      for (; !g_->passes.empty() && pass < g_->sample_light[next]; ++pass) light(pass);
      if (effect_) receive(next);
    };
    bool any = false;
    while (face < faces.size() || edge < edges.size()) {
      std::uint32_t v = ~0U;
      if (face < faces.size()) v = f_->volume_of_face[faces[face]];
      if (edge < edges.size()) v = std::min(v, f_->volume_of_edge[edges[edge]]);
      const std::uint32_t of = g_->volumes[v].sample;
      if (of != sample) close_sample(sample);
      if (of != sample || !any) start_sample(of);
      sample = of;
      any = true;
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
    paint(pass);
    const int samples = f_->config->count_bits > 0 ? g_->passes[pass] : 0;
    write_drawn(
        [&](std::uint32_t i) {
          Role role{PolygonWay::polygon, {}, &Line::shadow, {}, 1 + pass};
          if (layout_ != nullptr) {
            const PolygonLayout::Use use = layout_->lit(pass, i);
            role.way = use.way;
            role.place = layout_->light_place(pass, use.before);
          }
          return role;
        },
        f_->uses.lit(pass, 0), 0,
        [&](Line& line) {
          if (layout_ == nullptr && line.passes == pass) resolve(line, samples);
          line.passes = pass + 1;
        });
  }

  /// Give all parts the colours of a light.
  void paint(std::size_t pass) {
    if (painted_ == 1 + pass) return;
    painted_ = 1 + pass;
    for (const Drawn& d : drawn_) {
      std::size_t n = d.first_part;
      SpanToken s = d.span;
      spans_.painted(g_->polygons[d.polygon], d.y, s, 1 + pass,
                     [&](const SpanToken& part) { parts_[n++].span = part; });
    }
  }

  /// A sample begins: a pixel receives its shadow if some of its light comes to the part that the pixel shows.
  void receive(std::uint32_t sample) {
    const std::size_t light = sample < g_->sample_light.size() ? g_->sample_light[sample] : 0;
    if (received_ == light) return effect_->clear_flags();
    received_ = light;
    if (!g_->passes.empty()) paint(light);
    effect_->start_sample([&](std::uint32_t part) { return receives(parts_[part].span, light); });
  }

  /// Whether a part brings nothing of a light to any pixel, at whose ends it has the least and the most.
  [[nodiscard]] static bool is_dark(const Config& c, const SpanToken& part) {
    const int levels = derived::lane_level_bits(c) - 8;
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.channels); ++i)
      for (const int on : {0, part.xr - 1 - part.xl})
        if ((part.color[i] + on * part.dcolor[i]) >> (c.color_frac - levels) > 0) return false;
    return true;
  }

  [[nodiscard]] bool receives(const SpanToken& part, std::size_t light) const {
    const Config& c = *f_->config;
    if (!g_->passes.empty()) return !is_dark(c, part);
    if (part.normal_class == 0) return false;
    if (!derived::has_table(c)) return true;
    const auto& share =
        g_->shares[(static_cast<std::size_t>(part.normal_class) - 1) * static_cast<std::size_t>(c.lights) + light];
    return std::any_of(share.begin(), share.begin() + c.channels, [](std::uint32_t s) { return s != 0; });
  }

  void volume_face(std::uint32_t number, std::uint32_t volume) {
    const VolumeFace& face = g_->volume_faces[number];
    Role role = face_role(number, volume);
    const bool as_polygon = made(role.way);
    if (as_polygon) polygon(face.polygon, role);
    if (as_polygon && !keeps_origins_ && !effect_) return;
    // A cap that is drawn lies nowhere before what is drawn.
    if (effect_ && !as_polygon && face.polygon < g_->drawn) return;
    spans_.each(g_->polygons[face.polygon], y0_, y1_, [&](int y, SpanToken& s, int winding) {
      s.w = weight(*f_->config, winding * face.w);
      if (s.w == 0) return;
      Line& line = at(y);
      if (as_polygon) {
        if (keeps_origins_) line.origins.shadow.push_back({face.polygon, volume});
        if (effect_) effect_->count(y - y0_, s);
        line.has_polygon = true;
        line.volume.add(s.xl, s.xr);
      } else if (!effect_) {
        face_span(line, number, volume, role, s);
      } else {
        const Before before = effect_->count(y - y0_, s);
        if (before.pixels.none()) return;
        if (span_words_ != nullptr) span_words_->add(f_->uses.face(number), before.all ? Kind::NC : Kind::SP);
        if (before.all) {
          line.before_all.push_back({before.pixels.first, before.pixels.end, s.w});
        } else {
          line.held.push_back({number, restricted(s, before.pixels)});
        }
        line.volume.add(before.pixels.first, before.pixels.end);
      }
    });
  }

  [[nodiscard]] Role face_role(std::uint32_t number, std::uint32_t volume) const {
    Role role{PolygonWay::polygon, {}, &Line::shadow, {}, std::nullopt};
    if (layout_ == nullptr) return role;
    const PolygonLayout::Use use = layout_->face(number);
    role.way = use.way;
    role.place = layout_->place(volume, use.before);
    role.look.w = weight(*f_->config, g_->volume_faces[number].w);
    return role;
  }

  void face_span(Line& line, std::uint32_t number, std::uint32_t volume, const Role& role, const SpanToken& s) {
    const std::uint32_t polygon = g_->volume_faces[number].polygon;
    before_span(line, polygon, role);
    writer_.sp(s);
    if (keeps_origins_) line.origins.shadow.push_back({polygon, volume});
    line.volume.add(s.xl, s.xr);
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
      if (line.volume.none() && line.near.empty()) continue;
      std::vector<NearRun>& runs = near_runs_;
      runs.clear();
      each_run(line.near, [&](const NearRun& r) {
        line.volume.add(r.xl, r.xr);
        runs.push_back(r);
      });
      if (effect_) {
        for (const NearRun& r : runs) effect_->count_all(y - y0_, r.xl, r.xr, r.w);
        const bool found = !line.volume.none() && effect_->end_volume(y - y0_, line.volume.first, line.volume.end);
        if (found && span_words_ != nullptr) span_words_->add_volume(volume);
        if (!found && !line.has_polygon) {
          line.start_volume();
          continue;
        }
        for (const FaceSpan& held : line.held) {
          // Behind the polygons of the volume, which have been written.
          Role role = face_role(held.face, volume);
          if (layout_ != nullptr) role.place = layout_->place(volume, layout_->made_of(volume));
          face_span(line, held.face, volume, role, held.span);
        }
        add_before_all(line);
        join_runs(y);
      }
      for (const NearRun& r : runs) near_run(line, volume, r);
      if (!line.volume.none()) end_volume(line, volume);
      line.start_volume();
    }
  }

  template <class Use>
  void each_run(std::vector<Crossing>& near, Use use) const {
    std::stable_sort(near.begin(), near.end(), [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    fill_between(near, g_->width, [&](int xl, int xr, int winding) {
      const int w = weight(*f_->config, winding);
      if (w != 0) use(NearRun{xl, xr, w});
    });
  }

  /// Spans that lie before all that receives become runs, too: of all together where these are no more than they.
  void add_before_all(Line& line) {
    if (line.before_all.empty()) return;
    const std::size_t apart = near_runs_.size() + line.before_all.size();
    for (const NearRun& r : line.before_all) {
      line.near.push_back({r.xl, r.w});
      line.near.push_back({r.xr, -r.w});
    }
    joined_.clear();
    each_run(line.near, [&](const NearRun& r) { joined_.push_back(r); });
    if (joined_.size() <= apart)
      near_runs_.swap(joined_);
    else
      near_runs_.insert(near_runs_.end(), line.before_all.begin(), line.before_all.end());
  }

  /// Runs one after the other that count alike become one where no receiver lies between them.
  void join_runs(int y) {
    std::size_t kept = 0;
    for (std::size_t i = 1; i < near_runs_.size(); ++i) {
      NearRun& last = near_runs_[kept];
      const NearRun& next = near_runs_[i];
      const bool joins = next.w == last.w && next.xl >= last.xr && next.xl - last.xr <= kWidestJoin &&
                         effect_->nobody_receives(y - y0_, last.xr, next.xl);
      if (joins)
        last.xr = next.xr;
      else
        near_runs_[++kept] = next;
    }
    if (!near_runs_.empty()) near_runs_.resize(kept + 1);
  }

  void end_volume(Line& line, std::uint32_t volume) {
    if (f_->config->fsf != 0) {
      if (layout_ == nullptr) {
        writer_.write_to(line.shadow);
        writer_.ev(line.volume.first, line.volume.end);
      }
      if (keeps_origins_) line.origins.shadow.push_back({TokenOrigin::kNone, volume});
    }
    line.sample.add(line.volume.first, line.volume.end);
    line.open = true;
  }

  void close_sample(std::uint32_t sample) {
    if (f_->config->count_bits == 0 || layout_ != nullptr) return;
    for (int y = y0_; y < y1_; ++y) {
      Line& line = at(y);
      if (line.sample.none()) continue;
      writer_.write_to(line.shadow);
      writer_.es(line.sample.first, line.sample.end, g_->passes.empty() ? g_->sample_light[sample] : 0);
      line.sample = {};
    }
  }

  void near_run(Line& line, std::uint32_t volume, const NearRun& r) {
    writer_.write_to(line.shadow);
    if (layout_ != nullptr) go_to(line, layout_->place(volume, layout_->made_of(volume)));
    if (r.xl == 0 && r.xr == g_->width && layout_ == nullptr)
      writer_.inside(r.w);
    else
      writer_.nc(r.xl, r.xr, r.w);
    if (keeps_origins_) line.origins.shadow.push_back({TokenOrigin::kNone, volume});
  }

  const FramePlan* f_;
  bool keeps_origins_;
  SpanWords* span_words_;
  const FrameGeometry* g_;
  const PolygonLayout* layout_;  // at the polygon level
  BandWork work_;
  int y0_ = 0;
  int y1_ = 0;
  std::vector<std::uint32_t> words_;
  TokenWriter writer_;
  PolygonSpans spans_;
  PolygonReport written_;             // spans alone
  std::optional<BandEffect> effect_;  // unless all spans are written
  std::vector<Drawn> drawn_;
  std::vector<Part> parts_;
  std::size_t painted_ = 0;          // the pass of their colours
  std::size_t received_ = kNoLight;  // the light that effect_ has receivers of
  std::vector<NearRun> near_runs_;   // of the line and the volume at hand
  std::vector<NearRun> joined_;
  std::array<Line, kBandLines> lines_;
};

}  // namespace kage
