// SPDX-License-Identifier: Apache-2.0
//
// The words of a band of lines.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contract/derived.hpp"
#include "frontend/cut.hpp"
#include "frontend/scan.hpp"
#include "frontend/span_setup.hpp"
#include "frontend/sweep.hpp"
#include "frontend/tree_plan.hpp"
#include "kage/frontend.hpp"
#include "kage/token.hpp"

namespace kage {

/// What all bands share.
struct FramePlan {
  const FrameGeometry* geometry;
  const Config* config;
  TreePlan tree;
  std::vector<std::uint32_t> volume_of_face;
  std::vector<std::uint32_t> volume_of_edge;
  Sweep polygons;
  Sweep faces;
  Sweep edges;
  Sweep tree_edges;
  Sweep fragments;
};

/// What a band touches.
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
        writer_(*frame.config, words_),
        depth_(SpanSetup::depth(*frame.config)),
        color_(frame.config->color_frac, 10 + frame.config->color_frac),
        most_weight_(static_cast<int>(derived::most_dsf(*frame.config))) {}

  /// What the next band touches, to be filled in before make().
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

  void make(int band) {
    y0_ = band * kBandLines;
    y1_ = std::min(y0_ + kBandLines, g_->height);
    words_.clear();
    for (Line& line : lines_) line.clear();
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
      if (!line.shadow.empty()) writer_.resolve();
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
    Touched sample;  // of light
    FrameOrigins origins;

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
    }
  };

  Line& at(int y) { return lines_[static_cast<std::size_t>(y - y0_)]; }

  /// Call emit(y, span, winding) for every span of the polygon in the band; what a drawn polygon and a cap emit is the
  /// same.
  template <class Emit>
  void spans(const ScreenPolygon& p, Emit emit) {
    spans(p, y0_, y1_, emit);
  }

  template <class Emit>
  void spans(const ScreenPolygon& p, int y0, int y1, Emit emit) {
    scanner_.scan(g_->outline(p), y0, y1, g_->width, [&](int y, int xl, int xr, int winding) {
      depth_.each(p.depth, xl, xr, y, [&](int from, int to, SpanSetup::Ramp z) {
        SpanToken s;
        s.xl = from;
        s.xr = to;
        s.z = z.start;
        s.dz = z.step;
        emit(y, s, winding);
      });
    });
  }

  /// The colour of a span of the polygon on line y.
  void paint(const ScreenPolygon& p, int y, SpanToken& s) {
    const auto channels = static_cast<std::size_t>(f_->config->channels);
    for (std::size_t c = 0; c < channels; ++c) {
      if (f_->config->smooth == 0) {
        s.color[c] = p.color[c];
        continue;
      }
      const ScreenPlane plane = p.color_planes < 0 ? ScreenPlane{0, 0, std::int64_t{p.color[c]} << kPlaneFrac, 0, 0}
                                                   : g_->color_planes[static_cast<std::size_t>(p.color_planes) + c];
      const SpanSetup::Ramp r = color_.at(plane, s.xl, y, s.xr - s.xl);
      s.color[c] = static_cast<std::int32_t>(r.start);
      s.dcolor[c] = static_cast<std::int32_t>(r.step);
    }
  }

  void opaque() {
    for (const std::uint32_t i : work_.polygons) {
      if (i < f_->tree.first_span_polygon()) continue;
      const ScreenPolygon& p = g_->polygons[i];
      spans(p, [&](int y, SpanToken& s, int) {
        s.normal_class = span_class(p, *f_->config);
        paint(p, y, s);
        writer_.write_to(at(y).opaque);
        writer_.op(s);
        if (keeps_origins_) at(y).origins.opaque.push_back({i, TokenOrigin::kNone});
      });
    }
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
        spans(p, y0, y1, [&](int y, SpanToken& s, int) {
          int xl = s.xl;
          int xr = s.xr;
          for (const FragmentCut& cut : cuts) restrict_to(g_->cut_lines[cut.line], cut.front, y, xl, xr);
          if (xl >= xr) return;
          s.alpha = p.alpha;
          paint(p, y, s);
          const std::int64_t on = xl - s.xl;
          s.z += on * s.dz;
          for (std::size_t c = 0; c < 3; ++c) s.color[c] += static_cast<std::int32_t>(on) * s.dcolor[c];
          s.xl = xl;
          s.xr = xr;
          writer_.write_to(at(y).translucent);
          writer_.tp(s);
          if (keeps_origins_) at(y).origins.translucent.push_back({k, TokenOrigin::kNone});
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
    while (face < faces.size() || edge < edges.size()) {
      std::uint32_t v = ~0U;
      if (face < faces.size()) v = f_->volume_of_face[faces[face]];
      if (edge < edges.size()) v = std::min(v, f_->volume_of_edge[edges[edge]]);
      if (g_->volumes[v].sample != sample) close_sample(sample);
      sample = g_->volumes[v].sample;
      for (; face < faces.size() && f_->volume_of_face[faces[face]] == v; ++face)
        volume_face(g_->volume_faces[faces[face]], v);
      for (; edge < edges.size() && f_->volume_of_edge[edges[edge]] == v; ++edge)
        near_edge(g_->near_edges[edges[edge]]);
      close_volume(v);
    }
    close_sample(sample);
  }

  // w modulo 2^DSF_BITS, its sign kept where it fits; 0 if it has no effect.
  [[nodiscard]] int weight(int w) const { return w < 0 ? -(-w & most_weight_) : w & most_weight_; }

  void volume_face(const VolumeFace& face, std::uint32_t volume) {
    spans(g_->polygons[face.polygon], [&](int y, SpanToken& s, int winding) {
      s.w = weight(winding * face.w);
      if (s.w == 0) return;
      Line& line = at(y);
      writer_.write_to(line.shadow);
      writer_.sp(s);
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
        writer_.write_to(line.shadow);
        writer_.ev(line.volume.from, line.volume.to);
        if (keeps_origins_) line.origins.shadow.push_back({TokenOrigin::kNone, volume});
      }
      line.sample.add(line.volume.from, line.volume.to);
      line.volume = {};
    }
  }

  void close_sample(std::uint32_t sample) {
    if (f_->config->count_bits == 0) return;
    for (int y = y0_; y < y1_; ++y) {
      Line& line = at(y);
      if (line.sample.none()) continue;
      writer_.write_to(line.shadow);
      writer_.es(line.sample.from, line.sample.to, g_->sample_light[sample]);
      line.sample = {};
    }
  }

  void near_cap(Line& line, std::uint32_t volume) {
    std::stable_sort(line.near.begin(), line.near.end(),
                     [](const Crossing& a, const Crossing& b) { return a.x < b.x; });
    writer_.write_to(line.shadow);
    fill_between(line.near, g_->width, [&](int xl, int xr, int winding) {
      const int w = weight(winding);
      if (w == 0) return;
      if (xl == 0 && xr == g_->width)
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
  BandWork work_;
  int y0_ = 0;
  int y1_ = 0;
  std::vector<std::uint32_t> words_;
  TokenWriter writer_;
  SpanSetup depth_;
  SpanSetup color_;
  int most_weight_;
  Scanner scanner_;
  std::array<Line, kBandLines> lines_;
};

}  // namespace kage
