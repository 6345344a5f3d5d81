// SPDX-License-Identifier: Apache-2.0
//
// Error against cost: points, the frontier of those that no other beats in both, and names where it bends.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "explore/plot/drawing.hpp"

namespace kage::plot {

/// How an axis is divided and what it is called.
struct Axis {
  std::string title{};          ///< with the unit
  bool log = false;             ///< by decades
  bool more_is_better = false;  ///< as of a signal-to-noise ratio
  std::string none{};           ///< error only: what the place of points without an error is called
};

struct PlotPoint {
  int row = 0;      ///< Mark::row
  double cost = 0;  ///< above 0 if its axis is by decades
  std::optional<double>
      error{};              ///< none: there is no error, which is better than any; above 0 if its axis is by decades
  bool estimated = false;   ///< drawn hollow
  bool base = false;        ///< what the others are compared with: a diamond, and always named
  std::string name{};       ///< where there is room for one
  std::string full_name{};  ///< for who points at it
};

struct ParetoPlot {
  std::string title;
  std::string subtitle;
  Axis cost;
  Axis error;
  std::vector<PlotPoint> points;  ///< one at least
};

/// How large it is drawn.
struct PlotFormat {
  double width = 860;
  double height = 560;
  double text = 13;
};
inline constexpr PlotFormat kWidePlot{};
inline constexpr PlotFormat kNarrowPlot{.width = 340, .height = 420, .text = 12};

/// The points that no other beats, from the cheapest: none costs as little and is better, or costs less and is as good.
/// If points are alike, the first of them.
std::vector<std::size_t> frontier(const ParetoPlot& plot);

/// The places where a chain bends. They are both ends, and each place that is further than `far` from the straight line
/// between the kept ones beside it (Ramer, Douglas and Peucker); the farthest first, behind the ends.
std::vector<std::size_t> bends(const std::vector<Place>& chain, double far);

/// Draws it. Named are the base and the frontier's bends, further than a thirtieth of the plot's width, as far as there
/// is room for names that cover neither each other nor a point of the frontier.
Drawing draw(const ParetoPlot& plot, const PlotFormat& format);

}  // namespace kage::plot
