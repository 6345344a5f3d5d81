// SPDX-License-Identifier: Apache-2.0
//
// The oracle: the exact answer at a pixel, from the snapped polygons, by sign tests in 128-bit integers. It shares no
// arithmetic with the front end or the cores: no edge walking, no increments, no rounding. Slow, and meant to be.
//
// An answer unlike the oracle's is a near tie if the errors that docs/numbers.md states can give it; else it is gross,
// and a bug. Which errors count, the caller says: see Errors. Both are decided by outer intervals: every outline and
// every depth may err as far as its bound allows, each on its own.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kage/geometry.hpp"

namespace kage {

/// How far apart the snapped coordinates of a frame are, in 1/256 pixel.
inline int snap_step(const FrameGeometry& g) { return 1 << (8 - g.sub_bits); }

/// The truth at a pixel.
struct OraclePixel {
  std::int32_t surface = -1;  ///< nearest drawn polygon, the first in draw order among equals; -1: none
  bool shadowed = false;      ///< the surface's point is inside some volume
};

/// How an answer compares with the truth.
enum class Verdict : std::uint8_t {
  right,
  near_tie,  ///< unlike, and the stated errors can give it
  gross,     ///< unlike, and nothing excuses it: a bug
};

/// The errors that may part an answer from the truth.
enum class Errors : std::uint8_t {
  depth,           ///< the core's: sums along a span, and the rounding to an integer
  depth_and_snap,  ///< also the snap: every vertex moved by up to half a step of it in x and in y
};

/// Shadows that a pixel may have while every error stays within its bound.
struct PossibleShadow {
  bool lit = false;
  bool shadowed = false;
};

/// How many samples of a light may be in shadow while every error stays within its bound.
struct PossibleCount {
  int least = 0;
  int most = 0;
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

  /// The light samples that volumes keep from `surface`, a drawn polygon that the pixel shows. A shadow is calls of
  /// `shadowed` with the sample's number, more than one if several of its volumes hold the surface.
  template <class Shadowed>
  void shadows(int x, std::uint32_t surface, Shadowed&& shadowed) const {
    for (const Volume& v : volumes_)
      if (in_volume(v, x, surface)) shadowed(g_->volumes[v.index].sample);
  }

  /// The exact depth of a drawn polygon at the pixel, in steps of Z_BITS bits, clamped to what is drawn.
  [[nodiscard]] double exact_depth(int x, std::uint32_t surface) const;

  /// Judge an answer: the surface that was seen, and, if it is the right one, its shadow. Errors of depth only.
  [[nodiscard]] Verdict judge_surface(int x, const OraclePixel& truth, std::int32_t seen) const;
  [[nodiscard]] Verdict judge_shadow(int x, const OraclePixel& truth, bool seen) const;

  /// Whether the pixel may show `surface` (a drawn polygon, or -1 for none).
  [[nodiscard]] bool possible_surface(int x, std::int32_t surface, Errors errors) const;

  /// The shadows that `surface`, a drawn polygon that the pixel shows, may have there.
  [[nodiscard]] PossibleShadow possible_shadow(int x, std::uint32_t surface, Errors errors) const;

  /// The same by light. Each sample's shadow may err on its own, so every count between the two is possible.
  [[nodiscard]] std::array<PossibleCount, 8> possible_counts(int x, std::uint32_t surface, Errors errors) const;

  /// Sum over the volume of winding numbers with factor of all faces and the near cap at the pixel, whatever their
  /// depth. With the far end it is 0, so without it the sum is minus what the far end covers.
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

  // How an uncertain comparison or test comes out.
  enum class Sure : std::uint8_t { no, maybe, yes };

  [[nodiscard]] bool in_volume(const Volume& v, int x, std::uint32_t surface) const;
  [[nodiscard]] bool nearer(const ScreenPlane& a, const ScreenPlane& b, int x) const;
  [[nodiscard]] Sure surely_nearer(const ScreenPlane& a, const ScreenPlane& b, int x, Errors errors) const;
  [[nodiscard]] Sure surely_covers(std::uint32_t polygon, int x, Errors errors) const;
  [[nodiscard]] Sure surely_in_volume(const Volume& v, int x, std::uint32_t surface, Errors errors) const;
  [[nodiscard]] int near_cap(const Volume& v, int x) const;
  [[nodiscard]] int step() const { return snap_step(*g_); }
  [[nodiscard]] bool meets_line(std::span<const ScreenVertex> outline) const;

  const FrameGeometry* g_;
  Config config_;
  int y_ = 0;
  std::vector<std::uint32_t> drawn_;  // polygons whose box meets the line
  std::vector<Volume> volumes_;
};

}  // namespace kage
