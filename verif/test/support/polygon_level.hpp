// SPDX-License-Identifier: Apache-2.0
//
// Frames at the polygon level against the same at the span level.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

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
  const auto make = [&](std::vector<std::uint32_t>& words, const FrameOptions& options) {
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
  const auto draw = [&](std::span<const std::uint32_t> words) {
    std::vector<std::uint8_t> pixels;
    GoldenCore core(c);
    const FrameStatus status = core.frame(
        words, [&](int, std::span<const std::uint8_t> line) { pixels.insert(pixels.end(), line.begin(), line.end()); });
    if (status.error != ErrorCode::NONE) both.fault = describe(status);
    return pixels;
  };
  if (draw(both.spans) != draw(both.polygons)) both.fault = "pixels differ";
  if (both.counts.made != both.report.made().spans || both.report.words != both.polygons.size())
    both.fault = "the report counts otherwise";
  std::uint64_t spans = 0;
  for (const Kind k : {Kind::OP, Kind::SP, Kind::TP})
    spans += count_tokens(c, both.spans).of_kind[static_cast<std::size_t>(k)];
  if (both.report.all().spans != spans) both.fault = "the report misses spans";
  return both;
}

}  // namespace kage::verif
