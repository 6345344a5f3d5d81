// SPDX-License-Identifier: Apache-2.0
#include "kage/frontend.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <deque>

#include "arena/arena.hpp"
#include "contract/derived.hpp"
#include "frontend/band.hpp"
#include "kage/error.hpp"
#include "kage/token.hpp"

namespace kage {
namespace {

std::vector<LineRange> ranges_of_polygons(const FrameGeometry& g, std::size_t count) {
  std::vector<LineRange> r;
  r.reserve(count);
  for (std::size_t i = 0; i < count; ++i) r.push_back(lines_of(g.outline(g.polygons[i])));
  return r;
}

FramePlan prepare(const FrameGeometry& g, const Config& config, bool all_spans) {
  const int bands = (g.height + kBandLines - 1) / kBandLines;
  const auto all = ranges_of_polygons(g, g.polygons.size());
  std::vector<LineRange> faces;
  faces.reserve(g.volume_faces.size());
  for (const VolumeFace& f : g.volume_faces) faces.push_back(all[f.polygon]);
  std::vector<LineRange> edges;
  edges.reserve(g.near_edges.size());
  for (const NearEdge& e : g.near_edges) edges.push_back(lines_of(e.from, e.to));
  TreeLayout tree(g, config);
  std::vector<LineRange> ahead = tree.edge_lines();
  for (LineRange& r : ahead) --r.first, --r.end;
  std::vector<LineRange> fragments;
  fragments.reserve(g.fragments.size());
  for (const ScreenFragment& f : g.fragments) fragments.push_back({f.first_line, f.end_line});
  FramePlan f{&g,
              &config,
              std::move(tree),
              Uses(g, config),
              {},
              {},
              {bands, g.height, std::span(all).first(g.drawn)},
              {bands, g.height, faces},
              {bands, g.height, edges},
              {bands, g.height, ahead},
              {bands, g.height, fragments},
              all_spans,
              std::nullopt};
  f.volume_of_face.resize(g.volume_faces.size());
  f.volume_of_edge.resize(g.near_edges.size());
  for (std::uint32_t v = 0; v < g.volumes.size(); ++v) {
    const ShadowVolume& volume = g.volumes[v];
    std::fill_n(f.volume_of_face.begin() + volume.first_face, volume.face_count, v);
    std::fill_n(f.volume_of_edge.begin() + volume.first_near, volume.near_count, v);
  }
  return f;
}

/// Makes bands on several threads, a few at a time, and hands them on in order: memory holds no more than those.
class Bands {
 public:
  Bands(int height, int threads)
      : count_((height + kBandLines - 1) / kBandLines), wave_(threads == 1 ? 1 : 8), arena_(threads) {}

  Arena& arena() { return arena_; }

  /// Call take(band) for each, from the top. `made(n)` is the n-th of those that are made side by side.
  template <class Made, class Take>
  void make(FramePlan& frame, Made made, Take take) {
    std::deque<Band> bands;
    for (std::size_t i = 0; i < static_cast<std::size_t>(wave_); ++i) bands.push_back(made(i));
    for (int first = 0; first < count_; first += wave_) {
      const int end = std::min(first + wave_, count_);
      const auto of = [&](int b) -> Band& { return bands[static_cast<std::size_t>(b - first)]; };
      for (int b = first; b < end; ++b) {
        BandWork& work = of(b).work();
        work.polygons = frame.polygons.next();
        work.faces = frame.faces.next();
        work.edges = frame.edges.next();
        work.tree_edges = frame.tree_edges.next();
        work.fragments = frame.fragments.next();
      }
      if (wave_ == 1)
        of(first).make(first);
      else
        arena_.for_each(tbb::blocked_range<int>(first, end), [&](const tbb::blocked_range<int>& some) {
          for (int b = some.begin(); b < some.end(); ++b) of(b).make(b);
        });
      for (int b = first; b < end; ++b) take(of(b));
    }
  }

  /// Finds the words that polygons would take as spans. The frame stays as it is.
  SpanWords span_words(FramePlan frame) {
    const SpanWords none(*frame.geometry, frame.uses, *frame.config);
    std::deque<SpanWords> words(static_cast<std::size_t>(wave_), none);
    make(
        frame, [&](std::size_t n) { return Band(frame, false, &words[n]); }, [](const Band&) {});
    SpanWords all = none;
    for (const SpanWords& some : words) all += some;
    all.end();
    return all;
  }

 private:
  int count_;
  int wave_;
  Arena arena_;
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
    if (config.count_bits == 0 && g.passes.empty() && g.volumes[i].sample != g.volumes[0].sample)
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

// Throws Error if the configuration cannot hold the frame.
void check_fits(const FrameGeometry& g, const Config& config) {
  const int widest = (1 << config.x_bits) - 1;
  if (g.width > widest)
    throw Error(
        fmt::format("lines of {} pixels do not fit X_BITS = {}, which holds {}", g.width, config.x_bits, widest));
  check_guard(g);
  check_volumes(g, config);
  if (config.translucency == 0 && !g.fragments.empty())
    throw Error("translucent faces need TRANSLUCENCY, which the configuration lacks");
}

}  // namespace

void make_frame(const FrameGeometry& g, const Config& config, std::uint32_t number, const WordSink& sink,
                const FrameOptions& options) {
  FrameOrigins* const origins = options.origins;
  check_fits(g, config);
  if (options.level == Level::polygons && config.active == 0)
    throw Error("the polygon level needs ACTIVE, which the configuration lacks");
  const bool polygons = options.level == Level::polygons && PolygonLayout::fits(g);
  std::vector<std::uint32_t> words;
  TokenWriter writer(config, words);
  FrameHeader header{g.width, g.height, g.background, number};
  if (polygons) header.version = kPolygonVersion;
  writer.header(header);
  if (derived::has_table(config))
    write_table(g, config, writer);
  else if (config.dsf_bits > 0 && g.passes.empty() && !g.volumes.empty())
    writer.shade(g.shade);
  FramePlan frame = prepare(g, config, options.all_spans);
  Bands bands(g.height, options.threads);
  if (polygons) {
    std::optional<SpanWords> spans;
    if (!options.all_spans) spans = bands.span_words(frame);
    frame.layout.emplace(g, config, frame.tree.first_span_polygon(), spans ? &*spans : nullptr, bands.arena());
  }
  PolygonReport report;
  report.polygons = polygons;
  if (polygons) frame.layout->add_to(report);
  const auto pass_on = [&](std::span<const std::uint32_t> some) {
    report.words += some.size();
    sink(some);
  };
  if (options.report != nullptr) *options.report = frame.tree.report();
  if (origins != nullptr) *origins = {};
  if (frame.tree.any()) {
    frame.tree.faces(writer);
    std::vector<std::vector<std::uint32_t>> first;
    const auto lines = frame.tree.edge_lines();
    frame.tree.segments(0, 1, Sweep(1, 1, lines).next(), first);
    words.insert(words.end(), first[0].begin(), first[0].end());
  }
  pass_on(words);

  bands.make(
      frame, [&](std::size_t) { return Band(frame, origins != nullptr); },
      [&](const Band& band) {
        if (origins != nullptr) band.add_origins(*origins);
        if (polygons) band.add_spans(report);
        pass_on(band.words());
      });

  words.clear();
  writer.end();
  pass_on(words);
  if (options.polygons != nullptr) *options.polygons = report;
}

void make_frame(const FrameGeometry& g, const Config& config, std::uint32_t number, std::vector<std::uint32_t>& out,
                const FrameOptions& options) {
  make_frame(
      g, config, number,
      [&out](std::span<const std::uint32_t> words) { out.insert(out.end(), words.begin(), words.end()); }, options);
}

}  // namespace kage
