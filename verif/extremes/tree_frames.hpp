// SPDX-License-Identifier: Apache-2.0
//
// Frames with polyhedra, drawn by the golden core: their words, pixels and segments, and the law that no pixel depends
// on the way a polyhedron goes.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "frontend/polyhedron.hpp"
#include "kage/core.hpp"
#include "kage/frontend.hpp"
#include "kage/stream.hpp"

namespace kage::verif {

/// A frame and its picture.
struct Picture {
  std::vector<std::uint32_t> words;
  std::vector<std::uint32_t> pixels;
  TokenCounts counts;
  PolyhedraReport report;

  [[nodiscard]] std::uint64_t count(Kind kind) const { return counts.of_kind[static_cast<std::size_t>(kind)]; }
  /// Polyhedra that have a unit, that became spans, that cover no pixel.
  [[nodiscard]] int by_segments() const {
    return going([](int u) { return u >= 0; });
  }
  [[nodiscard]] int by_spans() const {
    return going([](int u) { return u == PolyhedraReport::kSpans; });
  }
  [[nodiscard]] int unseen() const {
    return going([](int u) { return u == PolyhedraReport::kUnseen; });
  }

 private:
  template <class Which>
  [[nodiscard]] int going(Which which) const {
    return static_cast<int>(std::count_if(report.unit_of.begin(), report.unit_of.end(), which));
  }
};

/// The golden core's pixels of a frame's words.
inline std::vector<std::uint32_t> pixels_of(const std::vector<std::uint32_t>& words, const Config& config) {
  std::vector<std::uint32_t> pixels;
  GoldenCore core(config);
  const FrameStatus status = core.frame(words, [&](int, std::span<const std::uint8_t> line) {
    for (std::size_t i = 0; i < line.size(); i += static_cast<std::size_t>(config.channels))
      pixels.push_back(config.channels == 1 ? line[i]
                                            : line[i] | static_cast<std::uint32_t>(line[i + 1]) << 8 |
                                                  static_cast<std::uint32_t>(line[i + 2]) << 16);
  });
  if (status.error != ErrorCode::NONE) throw std::runtime_error("the golden core refuses the front end's frame");
  return pixels;
}

inline Picture picture(const FrameGeometry& g, const Config& config) {
  Picture p;
  make_frame(g, config, 0, [&](std::span<const std::uint32_t> w) { p.words.insert(p.words.end(), w.begin(), w.end()); },
             {.threads = 1, .report = &p.report, .all_spans = true});
  p.counts = check_frame(config, p.words, "front end", 0);
  p.pixels = pixels_of(p.words, config);
  return p;
}

/// Calls what(token, place of its first word) for a frame's tokens of one kind, in order.
template <class What>
void each_token(const std::vector<std::uint32_t>& words, const Config& config, Kind kind, What what) {
  const Layout layout(config);
  TokenWalk walk(layout, words);
  for (auto token = walk.next(); !token.empty(); token = walk.next())
    if (kind_of(token[0]) == kind)
      what(decode(config, layout, token), static_cast<std::size_t>(token.data() - words.data()));
}

/// The segments of each unit's lines: [unit][line], of a frame that has a tree.
inline std::vector<std::vector<std::vector<SegmentToken>>> segments_of(const Picture& p, const Config& config) {
  std::vector<std::vector<std::vector<SegmentToken>>> lines(static_cast<std::size_t>(config.units));
  each_token(p.words, config, Kind::SEG, [&](const Token& t, std::size_t) {
    auto& unit = lines.at(static_cast<std::size_t>(t.segment.unit));
    if (t.segment.sync || unit.empty()) unit.emplace_back();
    unit.back().push_back(t.segment);
  });
  return lines;
}

/// Counts of a frame's segments, and the first broken rule. The rules hold whatever is on the segments: every line of
/// every unit sums to the width, none is empty or too long, and a unit is named iff a polyhedron has it.
struct SegmentCount {
  int units = 0;        ///< of the configuration
  int by_segments = 0;  ///< polyhedra
  int by_spans = 0;
  int unseen = 0;
  int units_used = 0;
  std::uint64_t segments = 0;  ///< SEG tokens, blank ones among them
  std::uint64_t of_faces = 0;  ///< SEG tokens that are not blank
  std::uint64_t face_pixels = 0;
  std::size_t most = 0;  ///< of a unit on a line
  int longest = 0;       ///< pixels of a segment
  std::string wrong;     ///< the first broken rule; empty: none

  void must(bool holds, const char* what) {
    if (!holds && wrong.empty()) wrong = fmt::format("{} units: {}", units, what);
  }
};

inline SegmentCount segment_count(const Picture& p, const FrameGeometry& g, const Config& config) {
  SegmentCount c;
  c.units = config.units;
  c.by_segments = p.by_segments();
  c.by_spans = p.by_spans();
  c.unseen = p.unseen();
  c.units_used = p.report.units;
  c.must(p.counts.units == p.report.units, "the frame has as many units as the report says");
  c.must(c.by_segments + c.by_spans + c.unseen == static_cast<int>(g.polyhedra.size()), "each polyhedron goes one way");
  // A frame has a tree if and only if a polyhedron goes to it.
  c.must(p.count(Kind::TREE) == (c.by_segments > 0 ? static_cast<std::uint64_t>(g.height) : 0),
         "a frame has a TREE a line iff a polyhedron goes by segments");
  if (c.by_segments == 0) {
    c.must(p.count(Kind::SEG) + p.count(Kind::FACE) == 0, "no segments without a tree");
    return c;
  }
  const int blank = (1 << config.face_bits) - 1;
  const auto units = segments_of(p, config);
  int bad_lines = 0;
  for (std::size_t u = 0; u < units.size(); ++u) {
    c.must(units[u].size() == static_cast<std::size_t>(g.height), "a unit has all lines");
    std::uint64_t pixels = 0;
    for (const auto& line : units[u]) {
      int sum = 0;
      int least = g.width;
      for (const SegmentToken& t : line) {
        sum += t.dx;
        least = std::min(least, t.dx);
        c.longest = std::max(c.longest, t.dx);
        if (t.face == blank) continue;
        ++c.of_faces;
        pixels += static_cast<std::uint64_t>(t.dx);
      }
      bad_lines += sum != g.width || least < 1 ? 1 : 0;
      c.segments += line.size();
      c.most = std::max(c.most, line.size());
    }
    const auto& of = p.report.unit_of;
    c.must((pixels > 0) == (std::find(of.begin(), of.end(), static_cast<int>(u)) != of.end()),
           "a unit has pixels iff a polyhedron has the unit");
    c.face_pixels += pixels;
  }
  c.must(bad_lines == 0, "segments of every line sum to the width, and none is empty");
  c.must(c.longest < 1 << config.dx_bits, "no segment is longer than DX_BITS hold");
  c.must(c.most <= std::size_t{1} << config.seg_bits, "no line has more segments than a unit buffers");
  return c;
}

/// The runs of all polyhedra of a frame: how many, and the longest.
struct RunCount {
  std::uint64_t runs = 0;
  int longest = 0;
};

inline RunCount count_runs(const FrameGeometry& g, const Config& config) {
  RunCount c;
  PolyhedronScanner scanner(g, config);
  for (const Polyhedron& p : g.polyhedra)
    scanner.scan(p, 0, g.height, [&](int, std::span<const Run> runs) {
      c.runs += runs.size();
      for (const Run& r : runs) c.longest = std::max(c.longest, r.xr - r.xl);
    });
  return c;
}

using PixelSpoil = std::function<void(std::vector<std::uint32_t>& pixels)>;

inline constexpr std::array<int, 8> kUnitCounts{1, 2, 3, 4, 5, 8, 9, 64};

/// The same frame by spans and with each of kUnitCounts units: the same pixels. Returns the counts of segments, in that
/// order, each with its error. `spoil` changes pixels by segments, for tests that must see it.
inline std::array<SegmentCount, kUnitCounts.size()> either_way_counts(const SceneFrame& f, Config config, int width,
                                                                      int height, const Look& look = {},
                                                                      const PixelSpoil& spoil = {}) {
  config.units = 0;
  const Picture spans = picture(make_geometry(f, config, width, height, {.look = look}), config);
  std::array<SegmentCount, kUnitCounts.size()> counts;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    config.units = kUnitCounts[i];
    const FrameGeometry g = make_geometry(f, config, width, height, {.look = look});
    Picture tree = picture(g, config);
    if (spoil) spoil(tree.pixels);
    counts[i] = segment_count(tree, g, config);
    counts[i].must(tree.pixels == spans.pixels, "pixels are those of the frame by spans");
    counts[i].must(spans.count(Kind::SEG) == 0, "a frame without units has no segments");
  }
  return counts;
}

}  // namespace kage::verif
