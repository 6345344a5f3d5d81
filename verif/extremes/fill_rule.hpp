// SPDX-License-Identifier: Apache-2.0
//
// Cases of families 1 - 9, 11 and 13: which pixels a polygon covers.
#pragma once

#include "extremes/fill_rule_checks.hpp"

namespace kage::verif {

/// A point on the screen or not far from it, in subpixels.
struct NearPoint {
  int x = 0;
  int y = 0;
  void fields(Fields& f);
  [[nodiscard]] ScreenVertex at() const { return {x, y}; }
};

/// Family 1: a rectangle in triangles, made by strewing points into it.
struct TriangulationCase {
  int x0 = 0, y0 = 0, width = 256, height = 256;  ///< the rectangle, in subpixels
  std::vector<NearPoint> points;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 2: a triangle, its corners in every order.
struct VertexOrderCase {
  NearPoint a, b, c;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 3: a quadrilateral cut along either diagonal, its corners at odd subpixels.
struct QuadCase {
  NearPoint a, b, c, d;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 4: a square of pixel centres cut by a line through its middle, from centre to centre.
struct CentresCase {
  int x = 40, y = 30;  ///< the middle, in pixels
  int r = 20;          ///< half of the side, in pixels
  int p = 0;           ///< the line's slope is p / r
  bool down = false;   ///< from top to bottom, else from side to side
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 5: triangles round one pixel centre, with the points of a square for their other corners.
struct FanCase {
  struct Rim {
    int at = 0;  ///< along the square's outline, of 4 x 12000 subpixels
    void fields(Fields& f);
  };
  int x = 40, y = 30;  ///< the pixel
  int half = 6000;     ///< half of the square's side, in subpixels
  std::vector<Rim> rim;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 6: slivers a subpixel wide and as long as the guard band.
struct SliverCase {
  bool upright = false, four = false;
  int near_end = 0, far_end = 0;  ///< how far within the guard band the ends are, in subpixels
  int from = 0, to = 0;           ///< where they are across, in subpixels
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 7: an outline that goes to and fro along one line.
struct FlatCase {
  struct Along {
    int at = 0;
    void fields(Fields& f);
  };
  int x = 0, y = 0, dx = 1, dy = 0;
  std::vector<Along> corners;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 8: an edge a subpixel high and as long as the guard band is wide.
struct LevelCase {
  int line = 0;         ///< that it meets
  int above = 0;        ///< subpixels that its upper end is above the line of centres
  bool falling = true;  ///< to the right
  int third = 0;        ///< x of the third corner
  bool below = true;    ///< where that is
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 9: corners at the guard band, and past it.
struct GuardCase {
  struct Corner {
    int kind_x = 0, kind_y = 0;
    int x = 0, y = 0;  ///< where the kind is "free"
    void fields(Fields& f);
  };
  Corner a, b, c;
  int past = 0;   ///< what one coordinate is instead
  int which = 0;  ///< of the six
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 11: a frame moved by whole pixels within the screen.
struct MovedCase {
  struct Face {
    int ax = 0, ay = 0, bx = 0, by = 0, cx = 0, cy = 0;
    double z = 1e6, a = 0, b = 0;  ///< its plane at the middle of the screen
    void fields(Fields& f);
  };
  int dx = 0, dy = 0;  ///< in pixels
  std::vector<Face> faces;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

/// Family 13: spans next to each other on one line, the later ones nearer.
struct JointsCase {
  struct Span {
    int pixels = 1;
    void fields(Fields& f);
  };
  std::vector<Span> spans;
  void fields(Fields& f);
  [[nodiscard]] Outcome check(const Context& context) const;
};

void add_fill_rule_families(Families& to);

}  // namespace kage::verif
