// SPDX-License-Identifier: Apache-2.0
//
// Ear clipping, seen along the polygon's mean normal. Convex polygons, nearly all there are, become fans.
#include "polygon.hpp"

#include <array>

#include "transform.hpp"

namespace kage::scene {
namespace {

// Newell: the area vector of the closed line, whatever its shape.
glm::dvec3 area_vector(const std::vector<glm::dvec3>& p) {
  glm::dvec3 sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < p.size(); ++i) sum += cross(p[i] - p[0], p[i + 1] - p[0]);
  return sum;
}

class Clipper {
 public:
  explicit Clipper(const std::vector<glm::dvec3>& p) : p_(p), normal_(area_vector(p)), left_(p.size()) {
    for (std::size_t i = 0; i < left_.size(); ++i) left_[i] = static_cast<std::uint32_t>(i);
  }

  std::vector<std::array<std::uint32_t, 3>> run() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    while (left_.size() > 3) {
      const std::size_t ear = find_ear();
      triangles.push_back({at(ear + left_.size() - 1), at(ear), at(ear + 1)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    if (left_.size() == 3) triangles.push_back({left_[0], left_[1], left_[2]});
    return triangles;
  }

 private:
  [[nodiscard]] std::uint32_t at(std::size_t i) const { return left_[i % left_.size()]; }
  [[nodiscard]] double side(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return dot(normal_, cross(p_[b] - p_[a], p_[c] - p_[a]));
  }

  // The first corner that turns the right way with no other inside; failing that (it crosses itself) the first.
  [[nodiscard]] std::size_t find_ear() const {
    for (std::size_t i = 1; i <= left_.size(); ++i)
      if (is_ear(i % left_.size())) return i % left_.size();
    return 1;
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const std::uint32_t a = at(i + left_.size() - 1);
    const std::uint32_t b = at(i);
    const std::uint32_t c = at(i + 1);
    if (!(side(a, b, c) > 0)) return false;
    for (const std::uint32_t v : left_) {
      if (v == a || v == b || v == c || p_[v] == p_[a] || p_[v] == p_[b] || p_[v] == p_[c]) continue;
      if (side(a, b, v) >= 0 && side(b, c, v) >= 0 && side(c, a, v) >= 0) return false;
    }
    return true;
  }

  const std::vector<glm::dvec3>& p_;
  glm::dvec3 normal_;
  std::vector<std::uint32_t> left_;
};

bool is_convex(const std::vector<glm::dvec3>& p) {
  const glm::dvec3 normal = area_vector(p);
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i)
    if (!(dot(normal, cross(p[(i + 1) % n] - p[i], p[(i + 2) % n] - p[(i + 1) % n])) > 0)) return false;
  return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<glm::dvec3>& corner) {
  // A line that winds more than once would pass as convex from 5 corners on, and its fan be as good as any.
  std::vector<std::array<std::uint32_t, 3>> fan;
  if (corner.size() < 3) return fan;
  if (corner.size() > 3 && !is_convex(corner)) return Clipper(corner).run();
  for (std::uint32_t i = 1; i + 1 < corner.size(); ++i) fan.push_back({0, i, i + 1});
  return fan;
}

}  // namespace kage::scene
