// SPDX-License-Identifier: Apache-2.0
//
// Frames at the polygon level against the same at the span level.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "direct/draw.hpp"
#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"
#include "stream/span_frame.hpp"

namespace kage::verif {

/// A frame's words at the span level: what the front end makes of a frame at the polygon level, in words again. Empty
/// if it finds an error.
inline std::vector<std::uint32_t> expanded(const Config& c, std::span<const std::uint32_t> words) {
  return span_frame(c, words).value_or(std::vector<std::uint32_t>{});
}

/// The lines of a frame as the golden core draws it, and what is wrong with it.
struct Drawn {
  std::vector<std::uint8_t> pixels;
  std::string fault;
};
inline Drawn drawn(const Config& c, std::span<const std::uint32_t> words) {
  Drawn d;
  GoldenCore core(c);
  const FrameStatus status = core.frame(words, [&](int, std::span<const std::uint8_t> line) {
    d.pixels.insert(d.pixels.end(), line.begin(), line.end());
  });
  if (status.error != ErrorCode::NONE) d.fault = describe(status);
  return d;
}

/// Compares a frame without tokens that have no effect, at both levels that the configuration has, with the same with
/// all spans. Says what is wrong; empty: nothing.
inline std::string effect_fault(const FrameGeometry& g, const Config& c, std::span<const std::uint32_t> all_spans) {
  const Drawn with = drawn(c, all_spans);
  for (const int threads : {1, 3}) {
    std::vector<std::uint8_t> direct;
    if (draws(c))
      draw_frame(
          g, c, threads, [] {},
          [&](int, std::span<const std::uint8_t> line) { direct.insert(direct.end(), line.begin(), line.end()); });
    if (draws(c) && direct != with.pixels) return "drawn without words it is another picture";
  }
  for (const Level level : {Level::spans, Level::polygons}) {
    if (level == Level::polygons && c.active == 0) continue;
    const std::string at = level == Level::spans ? "at the span level" : "at the polygon level";
    std::vector<std::uint32_t> words;
    FrameOrigins origins;
    make_frame(g, c, 7, words, {.threads = 1, .level = level});
    std::vector<std::uint32_t> threaded;
    make_frame(g, c, 7, threaded, {.threads = 3, .origins = &origins, .level = level});
    if (threaded != words) return "words depend on threads or origins " + at;
    std::vector<std::uint32_t> spans = words;
    try {
      check_frame(c, words, at, 0);
      if (level == Level::polygons) spans = expanded(c, words);
      check_frame(c, spans, at, 0);
    } catch (const std::exception& e) {
      return e.what();
    }
    const Drawn without = drawn(c, words);
    if (!without.fault.empty()) return without.fault + " " + at;
    if (without.pixels != with.pixels) return "spans without effect have one " + at;
    const TokenCounts counts = count_tokens(c, spans);
    const auto of = [&](Kind k) { return counts.of_kind[static_cast<std::size_t>(k)]; };
    if (origins.opaque.size() != of(Kind::OP) || origins.translucent.size() != of(Kind::TP) ||
        origins.shadow.size() != of(Kind::SP) + of(Kind::NC) + of(Kind::IF) + of(Kind::EV))
      return "origins are of other spans " + at;
    if (level == Level::spans && words.size() > all_spans.size()) return "fewer tokens are more words";
  }
  return {};
}

/// A frame at both levels.
struct BothLevels {
  std::vector<std::uint32_t> spans;
  std::vector<std::uint32_t> polygons;
  PolygonReport report;
  TokenCounts counts;
  std::string fault;  ///< what is wrong with the second; empty: nothing
};

/// Makes both, and compares all that must be the same: tokens, origins, pixels, and words with another number of
/// threads.
inline BothLevels both_levels(const FrameGeometry& g, const Config& c) {
  BothLevels both;
  const auto make = [&](std::vector<std::uint32_t>& words, FrameOptions options) {
    options.all_spans = true;  // as the levels leave out other ones: effect_fault() compares without
    make_frame(g, c, 7, words, options);
  };
  FrameOrigins of_spans;
  FrameOrigins of_polygons;
  make(both.spans, {.threads = 1, .origins = &of_spans});
  make(both.polygons, {.threads = 1, .level = Level::polygons, .polygons = &both.report});
  std::vector<std::uint32_t> threaded;
  make(threaded, {.threads = 3, .origins = &of_polygons, .level = Level::polygons});
  if (threaded != both.polygons) both.fault = "words depend on threads or origins";
  try {
    both.counts = check_frame(c, both.polygons, "the polygon level", 0);
  } catch (const std::exception& e) {
    both.fault = e.what();
    return both;
  }
  if (expanded(c, both.polygons) != both.spans) both.fault = "the front end makes other tokens";
  const auto same = [](const std::vector<TokenOrigin>& a, const std::vector<TokenOrigin>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const TokenOrigin& x, const TokenOrigin& y) {
      return x.polygon == y.polygon && x.volume == y.volume;
    });
  };
  if (!same(of_spans.opaque, of_polygons.opaque) || !same(of_spans.shadow, of_polygons.shadow) ||
      !same(of_spans.translucent, of_polygons.translucent))
    both.fault = "origins differ";
  const Drawn of_level = drawn(c, both.polygons);
  if (!of_level.fault.empty()) both.fault = of_level.fault;
  if (drawn(c, both.spans).pixels != of_level.pixels) both.fault = "pixels differ";
  if (both.counts.made != both.report.made().spans || both.report.words != both.polygons.size())
    both.fault = "the report counts otherwise";
  std::uint64_t spans = 0;
  for (const Kind k : {Kind::OP, Kind::SP, Kind::TP})
    spans += count_tokens(c, both.spans).of_kind[static_cast<std::size_t>(k)];
  if (both.report.all().spans != spans) both.fault = "the report misses spans";
  if (both.fault.empty()) both.fault = effect_fault(g, c, both.spans);
  return both;
}

}  // namespace kage::verif
