// SPDX-License-Identifier: Apache-2.0
//
// A polygon as the front end takes it (docs/stream.md, "The polygon level"): its planes at its first line, and each
// edge at the line where that edge begins. Also says whether the front end makes exactly the spans of scan conversion.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "frontend/polygon_spans.hpp"
#include "frontend/scan.hpp"
#include "kage/frontend.hpp"
#include "kage/geometry.hpp"
#include "kage/token.hpp"

namespace kage {

/// Where a polygon lies, and what the front end makes of it.
struct PolygonShape {
  std::uint16_t first = 0;  ///< first line on which it has a span
  std::uint16_t last = 0;   ///< last line
  std::uint16_t end = 0;    ///< one past the line where the earliest of its last edges ends
  std::uint16_t words = 0;  ///< of the AT and EDGE tokens behind its first line
  std::uint32_t spans = 0;  ///< on all lines; 0: it is not to be seen, and nothing else here counts
  PolygonWay as_face{};     ///< by its range and depth: how it can go as the face of a volume
  PolygonWay as_drawn{};    ///< by its colour, too
  bool operator==(const PolygonShape&) const = default;

  [[nodiscard]] int lines() const { return spans == 0 ? 0 : last - first + 1; }
};

/// Call emit(line, edge) for the edges that begin on the lines [y0, y1): those that cross its first line begin there,
/// whatever lies above.
template <class Emit>
void each_edge(std::span<const ScreenVertex> outline, const PolygonShape& shape, int y0, int y1, Emit emit) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const ScreenVertex& a = outline[i];
    const ScreenVertex& b = outline[i + 1 == outline.size() ? 0 : i + 1];
    const LineRange lines = lines_of(a, b);
    const int begin = std::max<int>(lines.first, shape.first);
    if (begin >= lines.end || begin > shape.last || begin < y0 || begin >= y1) continue;
    const bool down = a.y < b.y;
    const ScreenVertex& top = down ? a : b;
    const ScreenVertex& bottom = down ? b : a;
    PolygonToken t;
    t.side = down ? 0 : 1;
    t.last = lines.end == shape.end;
    t.top_x = top.x;
    t.top_y = top.y;
    t.bottom_x = bottom.x;
    t.bottom_y = bottom.y;
    emit(begin, t);
  }
}

/// Its depth's plane, as its POLYGON on line `first` has it. The slopes must fit.
PolygonToken depth_of(const Config& config, const ScreenPolygon& p, int first);

/// The plane of its colour in a channel, as GRADIENT has it. The slopes must fit. With linear light the front end adds
/// half of a step of 256, and the plane has what a pixel of more bits wants in place of it.
/// @param pass as color_plane() has it
PolygonToken gradient_of(const FrameGeometry& g, const Config& config, const ScreenPolygon& p, int first, int channel,
                         std::size_t pass);

/// Finds shapes; keeps its buffers.
class ShapeFinder {
 public:
  ShapeFinder(const FrameGeometry& geometry, const Config& config)
      : g_(&geometry), config_(&config), layout_(config), spans_(geometry, config) {}

  /// `drawn`: with colour, where that can differ from what the front end makes.
  PolygonShape find(const ScreenPolygon& p, bool drawn);

 private:
  struct Found {
    int y;
    SpanToken span;
    int winding;
  };
  struct Begin {
    int y;
    PolygonToken edge;
  };

  [[nodiscard]] bool two_crossings(const ScreenPolygon& p, PolygonShape& shape) const;
  [[nodiscard]] bool fits(const ScreenPlane& plane, int bits) const;
  void find_edges(const ScreenPolygon& p, PolygonShape& shape);
  void compare(const ScreenPolygon& p, PolygonShape& shape, std::optional<std::size_t> pass);

  const FrameGeometry* g_;
  const Config* config_;
  Layout layout_;
  PolygonSpans spans_;
  std::vector<Found> found_;
  std::vector<Begin> edges_;
};

}  // namespace kage
