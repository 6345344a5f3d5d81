// SPDX-License-Identifier: Apache-2.0
#include "kage/frontend.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>

#include "frontend/cut.hpp"
#include "frontend/scan.hpp"
#include "frontend/span_setup.hpp"
#include "frontend/sweep.hpp"
#include "frontend/tree_plan.hpp"
#include "kage/error.hpp"
#include "kage/stream.hpp"

namespace kage {
namespace {

/// What all bands share.
struct Frame {
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

std::vector<LineRange> ranges_of_polygons(const FrameGeometry& g, std::size_t count) {
  std::vector<LineRange> r;
  r.reserve(count);
  for (std::size_t i = 0; i < count; ++i) r.push_back(lines_of(g.outline(g.polygons[i])));
  return r;
}

Frame prepare(const FrameGeometry& g, const Config& config) {
  const int bands = (g.height + kBandLines - 1) / kBandLines;
  const auto all = ranges_of_polygons(g, g.polygons.size());
  std::vector<LineRange> faces;
  faces.reserve(g.volume_faces.size());
  for (const VolumeFace& f : g.volume_faces) faces.push_back(all[f.polygon]);
  std::vector<LineRange> edges;
  edges.reserve(g.near_edges.size());
  for (const NearEdge& e : g.near_edges) edges.push_back(lines_of(std::array{e.from, e.to}));
  TreePlan tree(g, config);
  std::vector<LineRange> ahead = tree.edge_lines();
  for (LineRange& r : ahead) --r.first, --r.end;
  std::vector<LineRange> fragments;
  fragments.reserve(g.fragments.size());
  for (const ScreenFragment& f : g.fragments) fragments.push_back({f.first_line, f.end_line});
  Frame f{&g,
          &config,
          std::move(tree),
          {},
          {},
          {bands, g.height, std::span(all).first(g.drawn)},
          {bands, g.height, faces},
          {bands, g.height, edges},
          {bands, g.height, ahead},
          {bands, g.height, fragments}};
  f.volume_of_face.resize(g.volume_faces.size());
  f.volume_of_edge.resize(g.near_edges.size());
  for (std::uint32_t v = 0; v < g.volumes.size(); ++v) {
    const ShadowVolume& volume = g.volumes[v];
    std::fill_n(f.volume_of_face.begin() + volume.first_face, volume.face_count, v);
    std::fill_n(f.volume_of_edge.begin() + volume.first_near, volume.near_count, v);
  }
  return f;
}

/// Makes the words of one band.
class Band {
 public:
  Band(const Frame& frame, const BandWork& work, int band)
      : f_(&frame),
        work_(&work),
        g_(frame.geometry),
        y0_(band * kBandLines),
        y1_(std::min(y0_ + kBandLines, g_->height)),
        writer_(*frame.config, words_),
        depth_(SpanSetup::depth(*frame.config)),
        color_(frame.config->color_frac, 10 + frame.config->color_frac) {}

  std::vector<std::uint32_t> make() {
    opaque();
    if (f_->config->dsf_bits > 0) volumes();
    if (f_->config->translucency > 0) translucent();
    const bool tree = f_->tree.any();
    std::vector<std::vector<std::uint32_t>> ahead;  // segments of line y + 1 at y - y0_
    if (tree) f_->tree.segments(y0_ + 1, std::min(y1_ + 1, g_->height), work_->tree_edges, ahead);
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
    return std::move(words_);
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
    for (const std::uint32_t i : work_->polygons) {
      if (i < f_->tree.first_span_polygon()) continue;
      const ScreenPolygon& p = g_->polygons[i];
      spans(p, [&](int y, SpanToken& s, int) {
        s.normal_class = span_class(p, *f_->config);
        paint(p, y, s);
        writer_.write_to(at(y).opaque);
        writer_.op(s);
      });
    }
  }

  // A fragment's span is a part of its face's, with the face's depth and colour there, bit for bit.
  void translucent() {
    for (const std::uint32_t i : work_->fragments) {
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
        });
      }
    }
  }

  void volumes() {
    const auto& faces = work_->faces;
    const auto& edges = work_->edges;
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
        volume_face(g_->volume_faces[faces[face]]);
      for (; edge < edges.size() && f_->volume_of_edge[edges[edge]] == v; ++edge)
        near_edge(g_->near_edges[edges[edge]]);
      close_volume();
    }
    close_sample(sample);
  }

  // w modulo 2^DSF_BITS, its sign kept where it fits; 0 if it has no effect.
  [[nodiscard]] int weight(int w) const { return w % (1 << f_->config->dsf_bits); }

  void volume_face(const VolumeFace& face) {
    spans(g_->polygons[face.polygon], [&](int y, SpanToken& s, int winding) {
      s.w = weight(winding * face.w);
      if (s.w == 0) return;
      Line& line = at(y);
      writer_.write_to(line.shadow);
      writer_.sp(s);
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

  void close_volume() {
    for (int y = y0_; y < y1_; ++y) {
      Line& line = at(y);
      if (!line.near.empty()) near_cap(line);
      if (line.volume.none()) continue;
      if (f_->config->fsf != 0) {
        writer_.write_to(line.shadow);
        writer_.ev(line.volume.from, line.volume.to);
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

  void near_cap(Line& line) {
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
      line.volume.add(xl, xr);
    });
    line.near.clear();
  }

  const Frame* f_;
  const BandWork* work_;
  const FrameGeometry* g_;
  int y0_;
  int y1_;
  std::vector<std::uint32_t> words_;
  TokenWriter writer_;
  SpanSetup depth_;
  SpanSetup color_;
  Scanner scanner_;
  std::array<Line, kBandLines> lines_;
};

void check_guard(const FrameGeometry& g) {
  constexpr std::int32_t kLimit = kGuard * 256;
  const auto check = [](const ScreenVertex& v, const char* what, std::size_t i) {
    if (v.x < -kLimit || v.x > kLimit || v.y < -kLimit || v.y > kLimit)
      throw Error(
          fmt::format("{} {}: ({}, {}) / 256 is outside the guard band of +-{} pixels", what, i, v.x, v.y, kGuard));
  };
  for (std::size_t i = 0; i < g.vertices.size(); ++i) check(g.vertices[i], "vertex", i);
  for (std::size_t i = 0; i < g.near_edges.size(); ++i) {
    check(g.near_edges[i].from, "near edge", i);
    check(g.near_edges[i].to, "near edge", i);
  }
}

// Without FSF a sample has one volume, without counters there is one sample.
void check_volumes(const FrameGeometry& g, const Config& config) {
  if (config.dsf_bits == 0) return;
  for (std::size_t i = 1; i < g.volumes.size(); ++i) {
    if (config.count_bits == 0 && g.volumes[i].sample != g.volumes[0].sample)
      throw Error("several light samples need COUNT_BITS, which the configuration lacks");
    if (config.fsf == 0 && g.volumes[i].sample == g.volumes[i - 1].sample)
      throw Error("several shadow volumes need FSF, which the configuration lacks");
  }
}

void write_table(const FrameGeometry& g, const Config& config, TokenWriter& writer) {
  const auto lights = static_cast<std::size_t>(config.lights);
  for (std::size_t i = 0; i < g.shares.size(); ++i)
    writer.table({static_cast<int>(i / lights) + 1, static_cast<int>(i % lights), g.shares[i]});
}

}  // namespace

void make_frame(const FrameGeometry& g, const Config& config, std::uint32_t number, const WordSink& sink, int threads,
                PolyhedraReport* report) {
  if (g.width > (1 << config.x_bits) - 1)
    throw Error(fmt::format("lines of {} pixels do not fit X_BITS = {}, which holds {}", g.width, config.x_bits,
                            (1 << config.x_bits) - 1));
  check_guard(g);
  const bool shadows = config.dsf_bits > 0 && !g.volumes.empty();
  check_volumes(g, config);
  if (config.translucency == 0 && !g.fragments.empty())
    throw Error("translucent faces need TRANSLUCENCY, which the configuration lacks");

  std::vector<std::uint32_t> words;
  TokenWriter writer(config, words);
  writer.header({g.width, g.height, g.background, number});
  if (config.class_bits > 1)
    write_table(g, config, writer);
  else if (shadows)
    writer.shade(g.shade);
  Frame frame = prepare(g, config);
  if (report != nullptr) *report = frame.tree.report();
  if (frame.tree.any()) {
    frame.tree.faces(writer);
    std::vector<std::vector<std::uint32_t>> first;
    const auto lines = frame.tree.edge_lines();
    frame.tree.segments(0, 1, Sweep(1, 1, lines).next(), first);
    words.insert(words.end(), first[0].begin(), first[0].end());
  }
  sink(words);

  const int bands = (g.height + kBandLines - 1) / kBandLines;
  // A few bands at a time, handed on in order: memory holds no more than those.
  const int wave = threads == 1 ? 1 : 8;
  std::vector<BandWork> work(static_cast<std::size_t>(wave));
  std::vector<std::vector<std::uint32_t>> made(static_cast<std::size_t>(wave));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  for (int first = 0; first < bands; first += wave) {
    const int end = std::min(first + wave, bands);
    for (int b = first; b < end; ++b)
      work[static_cast<std::size_t>(b - first)] = {frame.polygons.next(), frame.faces.next(), frame.edges.next(),
                                                   frame.tree_edges.next(), frame.fragments.next()};
    const auto make = [&](int b) {
      const auto i = static_cast<std::size_t>(b - first);
      made[i] = Band(frame, work[i], b).make();
    };
    if (wave == 1)
      make(first);
    else
      arena.execute([&] { tbb::parallel_for(first, end, make); });
    for (int b = first; b < end; ++b) sink(made[static_cast<std::size_t>(b - first)]);
  }

  words.clear();
  writer.end();
  sink(words);
}

void make_frame(const FrameGeometry& g, const Config& config, std::uint32_t number, std::vector<std::uint32_t>& out,
                int threads) {
  make_frame(
      g, config, number,
      [&out](std::span<const std::uint32_t> words) { out.insert(out.end(), words.begin(), words.end()); }, threads);
}

}  // namespace kage
