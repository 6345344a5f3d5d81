// SPDX-License-Identifier: Apache-2.0
#include "polygons.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "transform.hpp"

namespace kage::scene {
namespace {

constexpr std::uint32_t kNoTriangle = 0xffffffffU;

// Normals further apart than this are another face's: 1 - cos of 0.1 degrees, at which no colour differs.
constexpr double kNormalTolerance = 1.5e-6;

struct DirectedEdge {
  std::uint32_t from;
  std::uint32_t to;
  std::uint32_t triangle;
  bool operator<(const DirectedEdge& o) const { return from != o.from ? from < o.from : to < o.to; }
};

class Merger {
 public:
  Merger(const std::vector<glm::dvec3>& positions, std::span<const Corners> triangles,
         std::span<const Corners> shading_corners, const std::vector<ShadingVertex>& shading,
         std::span<const Surface> surfaces)
      : positions_(positions),
        triangles_(triangles),
        shading_corners_(shading_corners),
        shading_(shading),
        surfaces_(surfaces) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) edges_.push_back({triangles[t][i], triangles[t][(i + 1) % 3], t});
    std::sort(edges_.begin(), edges_.end());
    SpaceBox box;
    for (const Corners& t : triangles)
      for (const std::uint32_t v : t) box.add(positions[v]);
    tolerance_ = kPlanarTolerance * box.diagonal();
  }

  // The outline of each group, empty for all but the group's lowest triangle.
  std::vector<std::vector<std::uint32_t>> run(std::vector<std::uint32_t>& largest) {
    const std::size_t n = triangles_.size();
    std::vector<double> area(n);
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0U);
    for (std::size_t t = 0; t < n; ++t) area[t] = length(normal(static_cast<std::uint32_t>(t)));
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });
    group_.assign(n, kNoTriangle);
    largest.assign(n, kNoTriangle);
    std::vector<std::vector<std::uint32_t>> outlines(n);
    for (const std::uint32_t seed : order) {
      if (group_[seed] != kNoTriangle) continue;
      grow(seed);
      std::vector<std::uint32_t> outline = outline_of(seed);
      if (outline.empty()) {  // not one simple loop: leave its triangles as they are
        for (const std::uint32_t t : members_) {
          group_[t] = t;
          largest[t] = t;
          outlines[t].assign(triangles_[t].begin(), triangles_[t].end());
        }
        continue;
      }
      const std::uint32_t lowest = *std::min_element(members_.begin(), members_.end());
      largest[lowest] = seed;
      outlines[lowest] = std::move(outline);
    }
    return outlines;
  }

 private:
  [[nodiscard]] glm::dvec3 normal(std::uint32_t t) const {
    const Corners& c = triangles_[t];
    return cross(positions_[c[1]] - positions_[c[0]], positions_[c[2]] - positions_[c[0]]);
  }

  [[nodiscard]] std::uint32_t across(std::uint32_t from, std::uint32_t to) const {
    const auto it = std::lower_bound(edges_.begin(), edges_.end(), DirectedEdge{to, from, 0});
    return it != edges_.end() && it->from == to && it->to == from ? it->triangle : kNoTriangle;
  }

  [[nodiscard]] bool flat(std::uint32_t t) const {
    const Corners& c = shading_corners_[t];
    const auto same = [&](std::uint32_t a, std::uint32_t b) {
      return shading_[a].normal == shading_[b].normal && shading_[a].color == shading_[b].color;
    };
    return same(c[0], c[1]) && same(c[0], c[2]);
  }

  void grow(std::uint32_t seed) {
    members_.assign(1, seed);
    group_[seed] = seed;
    if (!flat(seed)) return;
    const glm::dvec3 n = unit(normal(seed), {0, 0, 0});
    const glm::dvec3& origin = positions_[triangles_[seed][0]];
    const ShadingVertex& look = shading_[shading_corners_[seed][0]];
    const auto fits = [&](std::uint32_t t) {
      if (!flat(t) || surfaces_[t] != surfaces_[seed]) return false;
      const ShadingVertex& s = shading_[shading_corners_[t][0]];
      if (s.color != look.color || 1 - dot(s.normal, look.normal) > kNormalTolerance) return false;
      return std::all_of(triangles_[t].begin(), triangles_[t].end(),
                         [&](std::uint32_t v) { return std::abs(dot(n, positions_[v] - origin)) <= tolerance_; });
    };
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const Corners c = triangles_[members_[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t t = across(c[k], c[(k + 1) % 3]);
        if (t == kNoTriangle || group_[t] != kNoTriangle || !fits(t)) continue;
        group_[t] = seed;
        members_.push_back(t);
      }
    }
  }

  // Counter-clockwise round the group, from its lowest corner (of one triangle: as it is); empty if it is not one
  // simple loop.
  [[nodiscard]] std::vector<std::uint32_t> outline_of(std::uint32_t seed) const {
    if (members_.size() == 1) return {triangles_[seed].begin(), triangles_[seed].end()};
    std::vector<std::array<std::uint32_t, 2>> border;
    for (const std::uint32_t t : members_)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles_[t][k];
        const std::uint32_t b = triangles_[t][(k + 1) % 3];
        const std::uint32_t other = across(a, b);
        if (other == kNoTriangle || group_[other] != seed) border.push_back({a, b});
      }
    if (border.empty()) return {};  // a body as thin as the tolerance, all of it in one plane
    std::sort(border.begin(), border.end());
    std::vector<std::uint32_t> outline;
    std::uint32_t at = border[0][0];
    for (std::size_t i = 0; i < border.size(); ++i) {
      const auto it = std::lower_bound(border.begin(), border.end(), std::array<std::uint32_t, 2>{at, 0});
      if (it == border.end() || (*it)[0] != at) return {};
      if (std::next(it) != border.end() && (*std::next(it))[0] == at) return {};  // touches itself
      outline.push_back(at);
      at = (*it)[1];
      if (at == outline[0] && i + 1 < border.size()) return {};
    }
    return outline;
  }

  const std::vector<glm::dvec3>& positions_;
  std::span<const Corners> triangles_;
  std::span<const Corners> shading_corners_;
  const std::vector<ShadingVertex>& shading_;
  std::span<const Surface> surfaces_;
  std::vector<DirectedEdge> edges_;
  double tolerance_ = 0;
  std::vector<std::uint32_t> group_;
  std::vector<std::uint32_t> members_;
};

}  // namespace

void append_polygons(const std::vector<glm::dvec3>& positions, std::span<const Corners> triangles,
                     std::span<const Corners> shading_corners, const std::vector<ShadingVertex>& shading,
                     std::span<const Surface> surfaces, std::uint32_t first, bool convex,
                     std::vector<Polygon>& polygons, std::vector<std::uint32_t>& corners) {
  if (!convex) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      polygons.push_back({static_cast<std::uint32_t>(corners.size()), 3, first + t});
      corners.insert(corners.end(), triangles[t].begin(), triangles[t].end());
    }
    return;
  }
  std::vector<std::uint32_t> largest;
  const auto outlines = Merger(positions, triangles, shading_corners, shading, surfaces).run(largest);
  for (std::size_t t = 0; t < outlines.size(); ++t) {
    if (outlines[t].empty()) continue;
    polygons.push_back({static_cast<std::uint32_t>(corners.size()), static_cast<std::uint32_t>(outlines[t].size()),
                        first + largest[t]});
    corners.insert(corners.end(), outlines[t].begin(), outlines[t].end());
  }
}

}  // namespace kage::scene
