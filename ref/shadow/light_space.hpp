// SPDX-License-Identifier: Apache-2.0
//
// Space as a light sees it: what lies on one ray of light is one point.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "shadow/count_bound.hpp"
#include "shadow/world_volume.hpp"

namespace kage {

/// A rectangle of light space that holds something, and more.
struct LightBox {
  std::array<double, 2> low{};
  std::array<double, 2> high{};

  [[nodiscard]] bool overlaps(const LightBox& o) const {
    return low[0] <= o.high[0] && o.low[0] <= high[0] && low[1] <= o.high[1] && o.low[1] <= high[1];
  }
  void add(const LightBox& o);
};

/// The charts that a set of casters needs: one where the light is at infinity or sees all of them within a cone, else
/// the six sides of a cube round the light. A vertex's place in a chart is rounded to 2^-40 of the chart's half width;
/// all counts are those of casters with vertices moved so.
class LightSpace {
 public:
  /// Refers to `frame`. `caps`: all that will be asked about.
  LightSpace(const SceneFrame& frame, const LightPoint& light, std::span<const CapFace> caps);

  /// The most of `caps`, whose sides are `sides`, that one ray of light meets. `high` is an upper bound
  /// (bound_count()). It is only as close as it takes to decide whether the number exceeds `target`; if `target` is
  /// below 0, as close as can be.
  [[nodiscard]] CountRange count(std::span<const CapFace> caps, std::span<const SideEdge> sides, int target) const;

  /// A rectangle round a face. Faces whose rectangles are apart have no ray of light in common.
  [[nodiscard]] LightBox box(const Polygon& p) const;

  /// Whether one chart holds all.
  [[nodiscard]] bool one_chart() const { return charts_ == 1; }

 private:
  struct Flat {
    double x;
    double y;
  };

  [[nodiscard]] glm::dvec3 place(std::uint32_t vertex) const;
  [[nodiscard]] static glm::dvec3 turned(const glm::dvec3& p, int chart);
  [[nodiscard]] Flat flat(const glm::dvec3& p) const;
  [[nodiscard]] ChartPoint on_chart(const Flat& f) const;
  [[nodiscard]] bool clip(glm::dvec3& a, glm::dvec3& b) const;
  [[nodiscard]] int corner_count(int chart, std::span<const CapFace> caps) const;

  const SceneFrame* frame_;
  LightPoint light_;
  std::array<glm::dvec3, 3> axes_;  // right, up, to the light
  int charts_ = 1;
  Flat middle_{0, 0};  // of the one chart
  double half_ = 1;    // half its width
};

}  // namespace kage
