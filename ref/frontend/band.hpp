// SPDX-License-Identifier: Apache-2.0
//
// A band of lines: what comes on each of its lines, in the order of tokens. A target takes it: BandWords writes it
// down.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contract/derived.hpp"
#include "frontend/band_effect.hpp"
#include "frontend/cut.hpp"
#include "frontend/frame_plan.hpp"
#include "frontend/polygon_spans.hpp"
#include "frontend/scan.hpp"
#include "frontend/weight.hpp"
#include "kernels/span_value.hpp"

namespace kage {

/// Makes one band after the other; keeps its buffers.
template <class Target>
class Band {
 public:
  /// With `words` it adds there what spans take. The target is made of `target`.
  template <class... Arguments>
  Band(const FramePlan& frame, SpanWords* words, Arguments&&... target)
      : f_(&frame),
        span_words_(words),
        g_(frame.geometry),
        target_(std::forward<Arguments>(target)...),
        spans_(*frame.geometry, *frame.config) {
    if (!frame.all_spans) effect_.emplace(*frame.geometry, *frame.config);
  }

  /// The next band's work, to be filled in before make().
  BandWork& work() { return work_; }
  [[nodiscard]] const Target& target() const { return target_; }

  void make(int band) {
    y0_ = band * kBandLines;
    y1_ = std::min(y0_ + kBandLines, g_->height);
    for (Line& line : lines_) line.clear();
    drawn_.clear();
    parts_.clear();
    painted_ = 0;
    received_ = kNoLight;
    target_.start(y0_, y1_);
    opaque();
    if constexpr (Target::kSkips) target_.end_opaque();
    if (f_->config->dsf_bits > 0) volumes();
    if (f_->config->translucency > 0) translucent();
    target_.end(work_);
  }

 private:
  using Role = typename Target::Role;

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
    // These are of the volume being worked on:
    std::vector<Crossing> near;
    std::vector<NearRun> before_all;  // spans that lie before all that receives
    std::vector<FaceSpan> held;       // those that depth decides, until the volume has an effect
    PixelRange volume;                // pixels that its tokens have touched
    bool has_polygon = false;         // it has one that goes as such

    PixelRange sample;       // of light
    std::size_t passes = 0;  // lights whose RESOLVE has come
    bool open = false;       // volumes have come, and no RESOLVE behind them

    void clear() {
      start_volume();
      sample = {};
      passes = 0;
      open = false;
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

  Line& at(int y) { return lines_[static_cast<std::size_t>(y - y0_)]; }

  void opaque() {
    if (effect_ || !g_->passes.empty()) return opaque_parts();
    // Nobody asks for a span again.
    for (const std::uint32_t i : work_.polygons) {
      if (i < f_->tree.first_span_polygon()) continue;
      const Role role = target_.opaque(i);
      if (target_.made(role)) target_.polygon(role);
      if (target_.made(role) && !target_.wants_made()) continue;
      const ScreenPolygon& p = g_->polygons[i];
      spans_.each(p, y0_, y1_, [&](int y, SpanToken& s, int) {
        spans_.painted(p, y, s, 0, [&](const SpanToken& part) { target_.op(y, role, part); });
      });
    }
  }

  void opaque_parts() {
    const bool again = !g_->passes.empty();
    if (effect_) effect_->start(y0_, y1_);
    for (const std::uint32_t i : work_.polygons) {
      const ScreenPolygon& p = g_->polygons[i];
      if (i < f_->tree.first_span_polygon() && !again && !effect_) continue;
      spans_.each(p, y0_, y1_, [&](int y, SpanToken& s, int) {
        drawn_.push_back({i, y, s, parts_.size(), 0});
        spans_.painted(p, y, s, 0, [&](const SpanToken& part) {
          parts_.push_back({part, {part.xl, part.xr}});
          if (effect_) effect_->draw(y, part);
        });
        drawn_.back().part_count = parts_.size() - drawn_.back().first_part;
      });
    }
    if (effect_) {
      effect_->end_drawing();
      for (std::uint32_t n = 0; n < parts_.size(); ++n) parts_[n].shown = effect_->shown(n);
    }
    write_drawn([&](std::uint32_t i) { return target_.opaque(i); }, Uses::drawn(0), f_->tree.first_span_polygon(),
                [](int) {});
  }

  /// The opaque polygons from a number on, by what parts_ shows of each, in the role that get_role(polygon) says; their
  /// uses begin with `first_use`. Calls start(y) before each span.
  template <class GetRole, class Start>
  void write_drawn(GetRole get_role, std::size_t first_use, std::uint32_t first_polygon, Start start) {
    auto drawn = drawn_.begin();
    for (const std::uint32_t i : work_.polygons) {
      const auto from = drawn;
      while (drawn != drawn_.end() && drawn->polygon == i) ++drawn;
      if (i < first_polygon) continue;
      const Role role = get_role(i);
      const bool as_polygon = target_.made(role);
      if (as_polygon) target_.polygon(role);
      for (auto d = from; d != drawn; ++d)
        for (std::size_t n = d->first_part; n < d->first_part + d->part_count; ++n) {
          const Part& part = parts_[n];
          if (!as_polygon && part.shown.none()) continue;
          start(d->y);
          target_.op(d->y, role, as_polygon ? part.span : restricted(part.span, part.shown));
          if (span_words_ != nullptr) span_words_->add(first_use + i, Kind::OP);
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
      for (std::uint32_t n = 0; n < f.polygon_count; ++n) {
        const ScreenPolygon& p = g_->polygons[f.first_polygon + n];
        const Role role = target_.translucent(i, n);
        const bool as_polygon = target_.made(role);
        if (as_polygon) target_.polygon(role);
        if (as_polygon && !target_.wants_made()) continue;
        spans_.each(p, y0, y1, [&](int y, SpanToken& s, int) {
          if (as_polygon) return target_.tp(y, role, s);
          int xl = s.xl;
          int xr = s.xr;
          for (const FragmentCut& cut : cuts) restrict_to(g_->cut_lines[cut.line], cut.front, y, xl, xr);
          if (xl >= xr) return;
          s.alpha = p.alpha;
          spans_.painted(p, y, s, 0, [&](const SpanToken& part) {
            PixelRange seen{std::max(part.xl, xl), std::min(part.xr, xr)};
            if (seen.first >= seen.end) return;
            SpanToken some = restricted(part, seen);
            if (effect_) {
              seen = effect_->before(y, some);
              if (seen.none()) return;
              some = restricted(some, seen);
            }
            target_.tp(y, role, some);
            if (span_words_ != nullptr) span_words_->add(f_->uses.translucent(i, n), Kind::TP);
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
    bool any = false;
    while (face < faces.size() || edge < edges.size()) {
      std::uint32_t v = ~0U;
      if (face < faces.size()) v = f_->volume_of_face[faces[face]];
      if (edge < edges.size()) v = std::min(v, f_->volume_of_edge[edges[edge]]);
      const std::uint32_t next = g_->volumes[v].sample;
      if (next != sample) close_sample(sample);
      if (next != sample || !any) {
        for (; !g_->passes.empty() && pass < g_->sample_light[next]; ++pass) light(pass);
        if (effect_) receive(next);
      }
      sample = next;
      any = true;
      for (; face < faces.size() && f_->volume_of_face[faces[face]] == v; ++face) volume_face(faces[face], v);
      for (; edge < edges.size() && f_->volume_of_edge[edges[edge]] == v; ++edge)
        near_edge(g_->near_edges[edges[edge]]);
      close_volume(v);
    }
    close_sample(sample);
    for (; pass < g_->passes.size(); ++pass) light(pass);
    // A line without a surface has volumes that no light's spans follow.
    for (int y = y0_; y < y1_ && !g_->passes.empty(); ++y)
      if (at(y).open) target_.resolve(y, 0);
  }

  /// The opaque spans once more, with a light's colours, those of units too: behind its volumes.
  void light(std::size_t pass) {
    paint(pass);
    const int samples = f_->config->count_bits > 0 ? g_->passes[pass] : 0;
    write_drawn([&](std::uint32_t i) { return target_.lit(pass, i); }, f_->uses.lit(pass, 0), 0,
                [&](int y) {
                  Line& line = at(y);
                  if (line.passes == pass) {
                    target_.resolve(y, samples);
                    line.open = false;
                  }
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
    constexpr std::array<std::uint32_t, 3> kDark{};
    return span_levels(c, part, part.xl) == kDark && span_levels(c, part, part.xr - 1) == kDark;
  }

  [[nodiscard]] bool receives(const SpanToken& part, std::size_t light) const {
    const Config& c = *f_->config;
    if (!g_->passes.empty()) return !is_dark(c, part);
    if (part.normal_class == 0) return false;
    if (!derived::has_table(c)) return true;
    const std::size_t row = (static_cast<std::size_t>(part.normal_class) - 1) * static_cast<std::size_t>(c.lights);
    const auto& share = g_->shares[row + light];
    return std::any_of(share.begin(), share.begin() + c.channels, [](std::uint32_t s) { return s != 0; });
  }

  void volume_face(std::uint32_t number, std::uint32_t volume) {
    const VolumeFace& face = g_->volume_faces[number];
    const ScreenPolygon& p = g_->polygons[face.polygon];
    const Role role = target_.face(number, volume);
    const bool as_polygon = target_.made(role);
    if (as_polygon) target_.polygon(role);
    if (as_polygon && !target_.wants_made() && !effect_) return;
    if (!as_polygon && (effect_ || Target::kSkips)) {
      // A cap that is drawn lies nowhere before what is drawn.
      if (face.polygon < g_->drawn) return;
      if constexpr (Target::kSkips)
        if (target_.hides(p)) return;
      if (effect_ && effect_->hides(p)) return;
    }
    spans_.each(p, y0_, y1_, [&](int y, SpanToken& s, int winding) {
      s.w = weight(*f_->config, winding * face.w);
      if (s.w == 0) return;
      if (effect_ && !as_polygon) return hold(y, number, s);
      if (effect_) effect_->count(y, s);
      at(y).has_polygon |= as_polygon;
      if (target_.sp(y, role, volume, s)) at(y).volume.add(s.xl, s.xr);
    });
  }

  /// A span of a face waits until its volume has an effect on the line, unless it counts at no pixel.
  void hold(int y, std::uint32_t face, const SpanToken& s) {
    const Before before = effect_->count(y, s);
    if (before.pixels.none()) return;
    Line& line = at(y);
    if (span_words_ != nullptr) span_words_->add(f_->uses.face(face), before.all ? Kind::NC : Kind::SP);
    if (before.all)
      line.before_all.push_back({before.pixels.first, before.pixels.end, s.w});
    else
      line.held.push_back({face, restricted(s, before.pixels)});
    line.volume.add(before.pixels.first, before.pixels.end);
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
      near_runs_.clear();
      each_run(line.near, [&](const NearRun& r) {
        line.volume.add(r.xl, r.xr);
        near_runs_.push_back(r);
      });
      if (!effect_ || has_effect(y, line, volume)) {
        for (const NearRun& r : near_runs_) target_.near(y, volume, r.xl, r.xr, r.w);
        if (!line.volume.none()) {
          if (f_->config->fsf != 0) target_.ev(y, volume, line.volume.first, line.volume.end);
          line.sample.add(line.volume.first, line.volume.end);
          line.open = true;
        }
      }
      line.start_volume();
    }
  }

  /// Whether a volume has an effect on a line. Then what was held of it goes to the target, but for near_runs_.
  bool has_effect(int y, Line& line, std::uint32_t volume) {
    for (const NearRun& r : near_runs_) effect_->count_all(y, r.xl, r.xr, r.w);
    const bool found = !line.volume.none() && effect_->end_volume(y, line.volume.first, line.volume.end);
    // A polygon counts on all of its lines, and the volume's other spans with it.
    if (!found && !line.has_polygon) return false;
    for (const FaceSpan& held : line.held) target_.sp(y, target_.last_face(held.face, volume), volume, held.span);
    add_before_all(line);
    join_runs(y);
    if (span_words_ != nullptr) span_words_->add_volume(volume, line.held.size(), near_runs_.size());
    return true;
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
                         effect_->nobody_receives(y, last.xr, next.xl);
      if (joins)
        last.xr = next.xr;
      else
        near_runs_[++kept] = next;
    }
    if (!near_runs_.empty()) near_runs_.resize(kept + 1);
  }

  void close_sample(std::uint32_t sample) {
    if (f_->config->count_bits == 0) return;
    for (int y = y0_; y < y1_; ++y) {
      Line& line = at(y);
      if (line.sample.none()) continue;
      target_.es(y, line.sample.first, line.sample.end, g_->passes.empty() ? g_->sample_light[sample] : 0);
      line.sample = {};
    }
  }

  const FramePlan* f_;
  SpanWords* span_words_;
  const FrameGeometry* g_;
  Target target_;
  BandWork work_;
  int y0_ = 0;
  int y1_ = 0;
  PolygonSpans spans_;
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
