// SPDX-License-Identifier: Apache-2.0
//
// The oracle: the exact answer at a pixel, from the snapped polygons, by sign tests in 128-bit integers. It shares no
// arithmetic with the front end or the cores: no edge walking, no increments, no rounding. Slow, and meant to be.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kage/geometry.hpp"

namespace kage {

/// What is true at a pixel.
struct OraclePixel {
  std::int32_t surface = -1;  ///< nearest drawn polygon, the first in draw order among equals; -1: none
  bool shadowed = false;      ///< the surface's point is inside some volume
};

/// How an answer compares with the truth.
enum class Verdict : std::uint8_t {
  right,
  near_tie,  ///< unlike, and the stated depth errors can give it
  gross,     ///< unlike, and nothing excuses it: a bug
};

class Oracle {
 public:
  /// Keeps a reference to `geometry`.
  Oracle(const FrameGeometry& geometry, const Config& config);

  /// Work on line y from now on.
  void line(int y);

  /// Winding number of an outline round the centre of pixel (x, y): each edge counts for the pixels at or right of it,
  /// its upper end included, its lower end not.
  [[nodiscard]] static int winding(std::span<const ScreenVertex> outline, int x, int y);

  /// Whether a drawn polygon covers the pixel.
  [[nodiscard]] bool covers(std::uint32_t polygon, int x) const;

  [[nodiscard]] OraclePixel at(int x) const;

  /// Judge an answer: the surface that was seen, and, if it is the right one, its shadow.
  [[nodiscard]] Verdict judge_surface(int x, const OraclePixel& truth, std::int32_t seen) const;
  [[nodiscard]] Verdict judge_shadow(int x, const OraclePixel& truth, bool seen) const;

  /// Sum over the volume of winding numbers with factor of all faces and the near cap at the pixel, whatever their
  /// depth; with the far end it is 0, so without it it is minus what the far end covers.
  [[nodiscard]] int sum_of_toggles(std::uint32_t volume, int x) const;

 private:
  struct Face {
    std::uint32_t polygon;
    std::int32_t w;
  };
  struct Volume {
    std::uint32_t index;
    std::vector<Face> faces;
    std::vector<NearEdge> near;
  };

  [[nodiscard]] bool nearer(const ScreenPlane& a, const ScreenPlane& b, int x) const;
  [[nodiscard]] bool within_error(const ScreenPlane& a, const ScreenPlane& b, int x) const;
  [[nodiscard]] int near_cap(const Volume& v, int x) const;

  const FrameGeometry* g_;
  Config config_;
  int y_ = 0;
  std::vector<std::uint32_t> drawn_;  // polygons whose box meets the line
  std::vector<Volume> volumes_;
};

}  // namespace kage
