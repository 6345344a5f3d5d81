// SPDX-License-Identifier: Apache-2.0
//
// How well points stand for an area light: how much of a light a straight edge truly keeps out, how many of the points,
// and how even the points are. Nothing of how kage chooses the points goes in.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numeric>
#include <vector>

#include "kage/light.hpp"
#include "oracle/directions.hpp"

namespace kage::verif {

/// The share of a round light, which looks like a disc of radius 1, beyond an edge at -1 <= h <= 1 from its middle.
inline double share_of_disc(double h) {
  h = std::clamp(h, -1.0, 1.0);
  return 0.5 + (std::asin(h) + h * std::sqrt(1 - h * h)) / M_PI;
}

/// The share of the square -1 .. 1 in x and y where c x + s y < h.
inline double share_of_square(double c, double s, double h) {
  c = std::abs(c);
  s = std::abs(s);
  if (c < s) std::swap(c, s);
  const double all = c + s;
  if (h <= -all) return 0;
  if (h >= all) return 1;
  if (s < 1e-9) return (h / c + 1) / 2;
  // The triangle that the edge cuts off the quadrant at the first corner, less what of it is beyond the two next ones.
  const auto triangle = [](double side) { return side > 0 ? side * side : 0; };
  return (triangle(h + all) - triangle(h + all - 2 * c) - triangle(h + all - 2 * s)) / (8 * c * s);
}

/// Places of a light's points in units of its size: over axis_u and axis_v, or of a ball in x, y and z of its radius.
inline std::vector<glm::dvec3> unit_points(const Light& light, const std::vector<LightPoint>& points) {
  std::vector<glm::dvec3> places;
  for (const LightPoint& p : points) {
    const glm::dvec3 off = p.position - light.position;
    if (light.shape == LightShape::sphere)
      places.push_back(off / light.axis_u.x);
    else
      places.emplace_back(glm::dot(off, light.axis_u) / glm::dot(light.axis_u, light.axis_u),
                          glm::dot(off, light.axis_v) / glm::dot(light.axis_v, light.axis_v), 0);
  }
  return places;
}

/// How far the share of the points beyond an edge is from the share of the light.
struct EdgeErrors {
  double squares = 0;  ///< sum over edges of the squared error, in shares of the light
  double worst = 0;    ///< in shares of the light
  int edges = 0;

  [[nodiscard]] double rms() const { return std::sqrt(squares / edges); }
};

/// Edges across `towards`, of length 1, at places that are even over the light's width. `square`: the light is one, in
/// x and y; else it is round.
inline void add_edges(const std::vector<glm::dvec3>& points, const glm::dvec3& towards, bool square, EdgeErrors& e) {
  constexpr int kPlaces = 400;
  std::vector<double> at;
  for (const glm::dvec3& p : points) at.push_back(glm::dot(p, towards));
  std::sort(at.begin(), at.end());
  const auto n = static_cast<double>(points.size());
  const double width = square ? std::abs(towards.x) + std::abs(towards.y) : 1;
  const auto truth = [&](double h) { return square ? share_of_square(towards.x, towards.y, h) : share_of_disc(h); };
  std::size_t beyond = 0;
  for (int k = 0; k < kPlaces; ++k) {
    const double h = width * (2 * (k + 0.5) / kPlaces - 1);
    while (beyond < at.size() && at[beyond] < h) ++beyond;
    const double off = static_cast<double>(beyond) / n - truth(h);
    e.squares += off * off;
  }
  e.edges += kPlaces;
  for (std::size_t i = 0; i < at.size(); ++i)  // the error is largest just before or behind a point
    for (const double count : {static_cast<double>(i), static_cast<double>(i + 1)})
      e.worst = std::max(e.worst, std::abs(count / n - truth(at[i])));
}

/// Edges of all directions: in the light's plane, or round a ball.
inline EdgeErrors edge_errors(LightShape shape, const std::vector<glm::dvec3>& points) {
  EdgeErrors e;
  if (shape == LightShape::sphere) {
    for (const glm::dvec3& d : even_directions(360)) add_edges(points, d, false, e);
    return e;
  }
  constexpr int kDirections = 360;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * M_PI * (i + 0.5) / kDirections;
    add_edges(points, {std::cos(angle), std::sin(angle), 0}, shape == LightShape::rectangle, e);
  }
  return e;
}

/// The unit square's numbers that points of a disc (area within, turn) or a rectangle (across both ways) come from.
inline std::vector<glm::dvec2> square_numbers(LightShape shape, const std::vector<glm::dvec3>& points) {
  std::vector<glm::dvec2> numbers;
  for (const glm::dvec3& p : points) {
    if (shape == LightShape::rectangle) {
      numbers.emplace_back((p.x + 1) / 2, (p.y + 1) / 2);
      continue;
    }
    const double turn = std::atan2(p.y, p.x) / (2 * M_PI);
    numbers.emplace_back(p.x * p.x + p.y * p.y, turn < 0 ? turn + 1 : turn);
  }
  return numbers;
}

/// The star discrepancy: the most by which the share of the numbers within a box from (0, 0) differs from its area.
/// Exact: it is taken on at the numbers' own coordinates, or at 1, with the border or without it.
inline double star_discrepancy(const std::vector<glm::dvec2>& numbers) {
  const std::size_t n = numbers.size();
  std::vector<std::size_t> by_x(n);
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) { return numbers[a].x < numbers[b].x; });
  double worst = 0;
  std::vector<double> below;  // y of the numbers left of the box's right border, in order
  for (std::size_t i = 0; i <= n; ++i) {
    const double x = i < n ? numbers[by_x[i]].x : 1;
    std::vector<double> with = below;
    if (i < n) with.insert(std::upper_bound(with.begin(), with.end(), numbers[by_x[i]].y), numbers[by_x[i]].y);
    const auto count = static_cast<double>(n);
    // Boxes without their border hold few for their area just before a number joins, boxes with it many just then.
    for (std::size_t k = 0; k <= below.size(); ++k)
      worst = std::max(worst, x * (k < below.size() ? below[k] : 1) - static_cast<double>(k) / count);
    for (std::size_t k = 0; k < with.size(); ++k)
      worst = std::max(worst, static_cast<double>(k + 1) / count - x * with[k]);
    below = std::move(with);
  }
  return worst;
}

}  // namespace kage::verif
