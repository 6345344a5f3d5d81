// SPDX-License-Identifier: Apache-2.0
#include "kage/frontend.hpp"

#include <deque>
#include <optional>

#include "contract/derived.hpp"
#include "frontend/band.hpp"
#include "frontend/band_words.hpp"
#include "frontend/frame_plan.hpp"
#include "kage/error.hpp"
#include "kage/token.hpp"

namespace kage {
namespace {

using WordBand = Band<BandWords>;

void write_table(const FrameGeometry& g, const Config& config, TokenWriter& writer) {
  const auto lights = static_cast<std::size_t>(config.lights);
  for (std::size_t i = 0; i < g.shares.size(); ++i)
    writer.table({static_cast<int>(i / lights) + 1, static_cast<int>(i % lights), g.shares[i]});
}

/// Finds the words that polygons would take as spans.
SpanWords span_words(FramePlan frame, Bands& bands) {
  const SpanWords none(*frame.geometry, frame.uses, *frame.config);
  std::deque<SpanWords> words(bands.wave(), none);
  std::deque<WordBand> made;
  for (SpanWords& some : words) made.emplace_back(frame, &some, frame, false);
  bands.make(frame, made, [](const WordBand&) {});
  SpanWords all = none;
  for (const SpanWords& some : words) all += some;
  all.end(*frame.geometry, frame.uses);
  return all;
}

}  // namespace

void make_frame(const FrameGeometry& g, const Config& config, std::uint32_t number, const WordSink& sink,
                const FrameOptions& options) {
  FrameOrigins* const origins = options.origins;
  FramePlan frame = plan_frame(g, config, options.all_spans);
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
  Bands bands(g.height, options.threads);
  std::optional<SpanWords> spans;
  if (polygons) {
    if (!options.all_spans) spans = span_words(frame, bands);
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

  std::deque<WordBand> made;
  for (std::size_t i = 0; i < bands.wave(); ++i) made.emplace_back(frame, nullptr, frame, origins != nullptr);
  bands.make(frame, made, [&](const WordBand& band) {
    if (origins != nullptr) band.target().add_origins(*origins);
    if (polygons) band.target().add_spans(report);
    pass_on(band.target().words());
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
